#include "deck/record.hpp"

#include <algorithm>
#include <cctype>
#include <set>
#include <utility>

#include <Teuchos_ParameterList.hpp>

#include "deck/words.hpp"
#include "deck/value.hpp"

namespace tanktread::deck {

namespace {

std::vector<std::string> names_in(const List& list) {
  std::vector<std::string> names;
  for (const Entry& entry : list.entries) names.push_back(entry.key);
  for (const auto& inner : list.lists) names.push_back(inner->name);
  names.insert(names.end(), list.mentioned.begin(), list.mentioned.end());
  return names;
}

/// Returns the path of the first key named `key` in `list` or its inner sections; empty if there is none.
std::string elsewhere(const List& list, const std::string& key) {
  for (const Entry& entry : list.entries)
    if (entry.key == key) return list.path_of(key);
  for (const auto& inner : list.lists)
    if (const std::string path = elsewhere(*inner, key); !path.empty()) return path;
  return {};
}

std::string unknown_key(const List& list, const List& root, const std::string& key) {
  const std::vector<std::string> names = names_in(list);
  const std::string path = list.path_of(key), what = path + " is not a key of the deck", missing = missing_feature(path);
  if (!missing.empty()) return what + ": " + missing + ".";
  std::string meant = guess(key, names);
  if (!meant.empty()) meant = list.path_of(meant);
  for (const std::string& name : {list.path_of(key), key})
    if (meant.empty()) meant = synonym(name);
  const std::string last = meant.substr(meant.rfind('/') + 1);
  if (meant.find(" or ") == meant.npos && std::ranges::find(names, last) != names.end()) meant = list.path_of(last);
  if (meant.empty()) meant = elsewhere(root, key);
  if (!meant.empty()) return what + "; was " + meant + " meant?";
  return what + "; " + (list.path.empty() ? "its sections are " : list.path + " has ") + alternatives(names) + ".";
}

/// Appends the messages about all sections inside `list` to `all`. `sentences`: function that returns the messages about one section (mistakes or
/// unknown keys). If the sections can inherit keys from each other, leaves out each message that differs from an earlier message only in the path.
template <class Sentences>
void add_inner(const List& list, const Sentences& sentences, std::vector<std::string>& all) {
  std::set<std::string> told;
  for (const auto& inner : list.lists)
    for (std::string& sentence : sentences(*inner)) {
      std::string without_path = sentence;
      for (const char* after : {"/", " "})
        for (std::size_t at; list.alike && (at = without_path.find(inner->path + after)) != std::string::npos;)
          without_path.erase(at, inner->path.size());
      if (!list.alike || told.insert(without_path).second) all.push_back(std::move(sentence));
    }
}

}  // namespace

std::vector<std::string> mistakes(const List& list) {
  std::vector<std::string> all = list.mistakes;
  add_inner(list, [](const List& inner) { return mistakes(inner); }, all);
  return all;
}

std::vector<std::string> idle_keys(const List& list) {
  std::vector<std::string> all = list.idle;
  add_inner(list, idle_keys, all);
  return all;
}

std::vector<std::string> unknown_keys(const List& list, const List& root) {
  std::vector<std::string> all;
  if (list.foreign) return all;
  if (list.given) {
    const std::vector<std::string> names = names_in(list);
    for (const auto& item : *list.given)
      if (std::ranges::find(names, item.first) == names.end()) all.push_back(unknown_key(list, root, item.first));
  }
  add_inner(list, [&root](const List& inner) { return unknown_keys(inner, root); }, all);
  return all;
}

std::string yaml_text(const List& list, int depth) {
  if (list.foreign) return yaml_text(*list.foreign, depth);
  const std::string indent(static_cast<std::size_t>(2 * depth), ' ');
  const auto name_text = [](const std::string& name) { return is_plain(name) ? name : in_quotes(name); };
  std::string out;
  for (const Entry& entry : list.entries)
    if (!entry.value.empty()) out += indent + name_text(entry.key) + ": " + entry.value + "\n";
  for (const auto& inner : list.lists) {
    const bool without_keys = inner->given && !inner->foreign && inner->entries.empty() && inner->lists.empty();
    if (const std::string text = yaml_text(*inner, depth + 1); !text.empty()) out += indent + name_text(inner->name) + ":\n" + text;
    else if (without_keys) out += indent + name_text(inner->name) + ": {}\n";
  }
  return out;
}

std::string markdown_text(const List& list) {
  const auto cell = [](std::string text) {
    for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, 1, '\\');
    return text;
  };
  std::string out;
  if (!list.path.empty()) {
    out += "## " + (list.path.find('<') == std::string::npos ? list.path : "`" + list.path + "`") + "\n\n";
    std::string meaning = list.meaning;
    if (!meaning.empty()) meaning.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(meaning.front())));
    if (!meaning.empty()) out += meaning + ".\n\n";
  }
  if (!list.entries.empty()) {
    out += "| key | default | values | unit | meaning |\n|---|---|---|---|---|\n";
    for (const Entry& e : list.entries) {
      const std::string fallback = e.fallback.empty() ? "" : "`" + e.fallback + "`";
      out += "| `" + e.key + "` | " + cell(fallback) + " | " + cell(e.values) + " | " + cell(e.unit) + " | " + cell(e.meaning) + " |\n";
    }
    out += "\n";
  }
  if (list.foreign)
    if (const std::string defaults = yaml_text(list, 0); !defaults.empty()) out += "Defaults:\n\n```yaml\n" + defaults + "```\n\n";
  for (const auto& inner : list.lists) out += markdown_text(*inner);
  return out;
}

}  // namespace tanktread::deck
