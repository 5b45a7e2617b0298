#include "deck/document.hpp"

#include <Teuchos_ParameterList.hpp>

#include "deck/record.hpp"
#include "deck/source.hpp"
#include "deck/value.hpp"
#include "deck/yaml.hpp"

namespace tanktread::deck {

namespace {

void add_values(const List& list, std::map<std::string, std::string>& out) {
  for (const Entry& entry : list.entries)
    if (!entry.value.empty()) out[list.path_of(entry.key)] = entry.value;
  if (list.foreign) out[list.path] = yaml_text(*list.foreign, 0);
  for (const auto& inner : list.lists) add_values(*inner, out);
}

}  // namespace

struct Document::Held {
  std::shared_ptr<Teuchos::ParameterList> given;
  bool documenting;
  List root;
};

Document::Document(std::shared_ptr<Teuchos::ParameterList> given, bool documenting)
    : held_(std::make_unique<Held>(Held{std::move(given), documenting, {}})) {
  held_->root.name = root_name;
  held_->root.given = held_->given.get();
}

Document::~Document() = default;
Document::Document(Document&&) noexcept = default;

Section Document::begin() { return Section(std::make_shared<Section::State>(Section::State{&held_->root, held_->documenting})); }

void Document::finish() const { refuse_unknown_keys(held_->root, held_->root); }

std::string Document::effective() const { return std::string(root_name) + ":\n" + yaml_text(held_->root, 1); }

std::map<std::string, std::string> Document::values() const {
  std::map<std::string, std::string> out;
  add_values(held_->root, out);
  return out;
}

std::string Document::reference() const { return markdown_text(held_->root); }

Document read(const std::vector<std::string>& files, const std::vector<std::string>& settings, const std::string& stored) {
  auto merged = std::make_shared<Teuchos::ParameterList>(root_name);
  if (!stored.empty()) overlay(*merged, *yaml_list(stored, "The stored deck"));
  for (const std::string& file : files) overlay(*merged, *file_list(file));
  for (const std::string& setting : settings) overlay(*merged, *setting_list(setting));
  return Document(merged);
}

Document read_text(const std::string& yaml, const std::string& origin) { return Document(yaml_list(yaml, origin)); }

}  // namespace tanktread::deck
