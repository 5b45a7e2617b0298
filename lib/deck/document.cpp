#include "deck/document.hpp"

#include <algorithm>
#include <iterator>
#include <optional>
#include <stdexcept>
#include <utility>

#include <Teuchos_ParameterList.hpp>

#include "deck/record.hpp"
#include "deck/source.hpp"
#include "deck/units.hpp"
#include "deck/value.hpp"
#include "deck/words.hpp"

namespace tanktread::deck {

namespace {

void add_values(const Record& section, std::map<std::string, std::string>& out) {
  for (const Entry& entry : section.entries)
    if (!entry.value.empty()) out[section.path_of(entry.key)] = entry.value;
  if (section.foreign) out[section.path] = yaml_text(*section.foreign, 0);
  for (const auto& inner : section.sections) add_values(*inner, out);
}

const Teuchos::ParameterList* sublist(const Teuchos::ParameterList* list, const std::string& name) {
  return list && list->isSublist(name) ? &list->sublist(name) : nullptr;
}

/// Appends to `changes` the path of each key of `over` that `base` does not have or that has another value in `base`. Skips Output and Expect.
void add_changes(const Teuchos::ParameterList* base, const Teuchos::ParameterList& over, const std::string& path,
                 std::vector<std::string>& changes) {
  for (const auto& item : over) {
    const std::string here = path + item.first;
    if (here == "Output" || here == "Expect") continue;
    const Teuchos::ParameterEntry* before = base ? base->getEntryPtr(item.first) : nullptr;
    if (item.second.isList())
      add_changes(sublist(base, item.first), over.sublist(item.first), here + "/", changes);
    else if (!before || !same_value(*before, item.second))
      changes.push_back(here);
  }
}

/// Returns the units of a deck, or nothing if its section Units is missing or wrong. A wrong section is reported later, when the deck is declared.
std::optional<Units> units(const Teuchos::ParameterList& deck) try {
  const Teuchos::ParameterList* given = sublist(&deck, "Units");
  if (!given) return {};
  UnitOptions options;
  Document(std::make_shared<Teuchos::ParameterList>(*given)).declare(options);
  return Units(options);
} catch (const UserError&) {
  return {};
}

/// Returns the time of an entry in the deck's unit of time, or nothing if the entry is no time.
std::optional<double> time_of(const Teuchos::ParameterEntry& entry, const std::optional<Units>& units) try {
  const auto text = units ? as_text(entry) : std::nullopt;
  return text ? units->number(*text, "time") : as_number(entry);
} catch (const std::invalid_argument&) {
  return {};
}

/// The merged deck, and for each expectation the keys that were changed by files or settings after it was declared.
struct Layers {
  std::shared_ptr<Teuchos::ParameterList> merged = std::make_shared<Teuchos::ParameterList>(root_name);
  std::map<std::string, std::vector<std::string>> changed;

  void add(const Teuchos::ParameterList& over) {
    const Teuchos::ParameterList* stated = sublist(&over, "Expect");
    std::vector<std::string> changes;
    add_changes(merged.get(), over, "", changes);
    for (auto& [name, keys] : changed) keys.insert(keys.end(), changes.begin(), changes.end());
    if (stated)
      for (const auto& item : *stated) {
        changed[item.first].clear();
        if (sublist(sublist(merged.get(), "Expect"), item.first))
          merged->sublist("Expect").sublist(item.first).remove("not binding", false);
      }
    overlay(*merged, over);
  }

  /// Returns whether the expected value (section Expect of the deck) has a time `at` that is not later than Time/final time. A change of the final
  /// time does not affect such a value.
  bool before_end(const Teuchos::ParameterList& expectation, const std::optional<Units>& units) const {
    const Teuchos::ParameterList* time = sublist(merged.get(), "Time");
    const auto *at = expectation.getEntryPtr("at"), *end = time ? time->getEntryPtr("final time") : nullptr;
    const auto from = at ? time_of(*at, units) : std::nullopt, to = end ? time_of(*end, units) : std::nullopt;
    return from && to && *from <= *to;
  }

  void excuse(const std::string& all) {
    const std::optional<Units> own = changed.empty() ? std::nullopt : units(*merged);
    for (auto& [name, keys] : changed) {
      if (!sublist(sublist(merged.get(), "Expect"), name)) continue;
      Teuchos::ParameterList& expectation = merged->sublist("Expect").sublist(name);
      const Teuchos::ParameterEntry* const reason = expectation.getEntryPtr("not binding");
      if (reason && !as_text(*reason)) continue;  // a value of another type is reported later, when the deck is declared
      if (before_end(expectation, own)) std::erase(keys, "Time/final time");
      std::ranges::sort(keys);
      keys.erase(std::ranges::unique(keys).begin(), keys.end());
      if (!all.empty())
        expectation.set("not binding", all);
      else if (!keys.empty() && (!reason || as_text(*reason)->empty()))
        expectation.set("not binding", "the deck was changed: " + joined(keys, " and "));
    }
  }
};

}  // namespace

Document::Document(std::shared_ptr<const Teuchos::ParameterList> given, bool documenting)
    : given_(std::move(given)), documenting_(documenting), root_(std::make_shared<Record>()) {
  root_->name = root_name;
  root_->given = given_.get();
}

Section Document::begin() { return Section(std::make_shared<Section::State>(Section::State{root_.get(), documenting_, {}})); }

void Document::refuse_wrong_values() const { require_none(mistakes(*root_)); }

void Document::finish() const {
  std::vector<std::string> all = mistakes(*root_);
  std::ranges::copy(unknown_keys(*root_, *root_), std::back_inserter(all));
  require_none(std::move(all));
}

std::string Document::effective() const { return std::string(root_name) + ":\n" + yaml_text(*root_, 1); }

std::map<std::string, std::string> Document::values() const {
  std::map<std::string, std::string> out;
  add_values(*root_, out);
  return out;
}

std::string Document::reference() const { return markdown_text(*root_); }

std::string Document::schema() const {
  return R"({"$schema": "http://json-schema.org/draft-07/schema#", "type": "object", "properties": {)" + in_quotes(root_name) + ": " +
         schema_text(*root_, 0) + R"(}, "required": [)" + in_quotes(root_name) + "]}\n";
}

std::string Document::commented() const { return std::string(root_name) + ":\n" + commented_text(*root_, 1); }

Document read(const std::vector<std::string>& files, const std::vector<std::string>& settings, const std::string& stored,
              const std::string& excuse) {
  Layers layers;
  if (!stored.empty()) layers.add(*yaml_list(stored, "The stored deck"));
  for (const std::string& file : files) layers.add(*file_list(file));
  Teuchos::ParameterList set;
  for (const std::string& setting : settings) overlay(set, *setting_list(setting));
  layers.add(set);
  layers.excuse(excuse);
  return Document(layers.merged);
}

Document read_text(const std::string& yaml, const std::string& origin) { return Document(yaml_list(yaml, origin)); }

}  // namespace tanktread::deck
