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

std::vector<std::string> names_in(const Record& section) {
  std::vector<std::string> names;
  for (const Entry& entry : section.entries) names.push_back(entry.key);
  for (const auto& inner : section.sections) names.push_back(inner->name);
  names.insert(names.end(), section.mentioned.begin(), section.mentioned.end());
  return names;
}

/// Returns the path of the first key named `key` in `section` or its inner sections; empty if there is none.
std::string elsewhere(const Record& section, const std::string& key) {
  for (const Entry& entry : section.entries)
    if (entry.key == key) return section.path_of(key);
  for (const auto& inner : section.sections)
    if (const std::string path = elsewhere(*inner, key); !path.empty()) return path;
  return {};
}

std::string unknown_key(const Record& section, const Record& root, const std::string& key) {
  const std::vector<std::string> names = names_in(section);
  const std::string path = section.path_of(key), what = path + " is not a key of the deck", missing = missing_feature(path);
  if (!missing.empty()) return what + ": " + missing + ".";
  std::string meant = guess(key, names);
  if (!meant.empty()) meant = section.path_of(meant);
  for (const std::string& name : {section.path_of(key), key})
    if (meant.empty()) meant = synonym(name);
  const std::string last = meant.substr(meant.rfind('/') + 1);
  if (meant.find(" or ") == meant.npos && std::ranges::find(names, last) != names.end()) meant = section.path_of(last);
  if (meant.empty()) meant = elsewhere(root, key);
  if (!meant.empty()) return what + "; was " + meant + " meant?";
  return what + "; " + (section.path.empty() ? "its sections are " : section.path + " has ") + alternatives(names) + ".";
}

/// Appends the messages about all sections inside `section` to `all`. `sentences`: function that returns the messages about one section (mistakes or
/// unknown keys). If the sections can inherit keys from each other, leaves out each message that differs from an earlier message only in the path.
template <class Sentences>
void add_inner(const Record& section, const Sentences& sentences, std::vector<std::string>& all) {
  std::set<std::string> told;
  for (const auto& inner : section.sections)
    for (std::string& sentence : sentences(*inner)) {
      std::string without_path = sentence;
      for (const char* after : {"/", " "})
        for (std::size_t at; section.alike && (at = without_path.find(inner->path + after)) != std::string::npos;)
          without_path.erase(at, inner->path.size());
      if (!section.alike || told.insert(without_path).second) all.push_back(std::move(sentence));
    }
}

/// Returns the sentences of one kind about a section, followed by the sentences about its inner sections.
std::vector<std::string> all_of(const Record& section, std::vector<std::string> Record::* sentences) {
  std::vector<std::string> all = section.*sentences;
  add_inner(section, [sentences](const Record& inner) { return all_of(inner, sentences); }, all);
  return all;
}

}  // namespace

std::string numbers_text(const ValueType& type, const std::string& brackets) {
  const bool several = type.count != 1;
  const std::string size(type.kind == ValueType::whole ? "a whole number" : numbers_in_words.at(static_cast<std::size_t>(type.count)));
  return size + (several ? brackets : "") + (type.rule.text == any().text ? "" : (several ? ", each " : ", ") + type.rule.text);
}

std::string values_text(const ValueType& type) {
  if (type.kind == ValueType::truth) return "true or false";
  if (type.kind != ValueType::text) return type.count != 1 ? numbers_text(type) : (type.kind == ValueType::whole ? "whole, " : "") + type.rule.text;
  std::string words;
  for (const std::string& word : type.words) words += (words.empty() ? "`" : ", `") + word + "`";
  return words.empty() ? "text" : words;
}

std::vector<std::string> mistakes(const Record& section) { return all_of(section, &Record::mistakes); }

std::vector<std::string> idle_keys(const Record& section) { return all_of(section, &Record::idle); }

std::vector<std::string> unusual_values(const Record& section) { return all_of(section, &Record::unusual); }

std::vector<std::string> unknown_keys(const Record& section, const Record& root) {
  std::vector<std::string> all;
  if (section.foreign) return all;
  if (section.given) {
    const std::vector<std::string> names = names_in(section);
    for (const auto& item : *section.given)
      if (std::ranges::find(names, item.first) == names.end()) all.push_back(unknown_key(section, root, item.first));
  }
  add_inner(section, [&root](const Record& inner) { return unknown_keys(inner, root); }, all);
  return all;
}

std::string yaml_text(const Record& section, int depth) {
  if (section.foreign) return yaml_text(*section.foreign, depth);
  const std::string indent(static_cast<std::size_t>(2 * depth), ' ');
  const auto name_text = [](const std::string& name) { return is_plain(name) ? name : in_quotes(name); };
  std::string out;
  for (const Entry& entry : section.entries)
    if (!entry.value.empty()) out += indent + name_text(entry.key) + ": " + entry.value + "\n";
  for (const auto& inner : section.sections) {
    if (const std::string text = yaml_text(*inner, depth + 1); !text.empty()) out += indent + name_text(inner->name) + ":\n" + text;
    else if (inner->given && !inner->foreign) out += indent + name_text(inner->name) + ": {}\n";
  }
  return out;
}

std::string markdown_text(const Record& section) {
  const auto cell = [](std::string text) {
    for (std::size_t at = 0; (at = text.find('|', at)) != std::string::npos; at += 2) text.insert(at, 1, '\\');
    return text;
  };
  std::string out;
  if (!section.path.empty()) {
    out += "## " + (section.path.find('<') == std::string::npos ? section.path : "`" + section.path + "`") + "\n\n";
    std::string meaning = section.meaning;
    if (!meaning.empty()) meaning.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(meaning.front())));
    if (!meaning.empty()) out += meaning + ".\n\n";
  }
  if (!section.entries.empty()) {
    out += "| key | default | values | unit | meaning |\n|---|---|---|---|---|\n";
    for (const Entry& e : section.entries) {
      const std::string fallback = e.fallback.empty() ? "" : "`" + e.fallback + "`";
      out += "| `" + e.key + "` | " + cell(fallback) + " | " + cell(values_text(e.type)) + " | " + cell(e.unit) + " | " + cell(e.meaning) + " |\n";
    }
    out += "\n";
  }
  if (section.foreign)
    if (const std::string defaults = yaml_text(section, 0); !defaults.empty()) out += "Defaults:\n\n```yaml\n" + defaults + "```\n\n";
  for (const auto& inner : section.sections) out += markdown_text(*inner);
  return out;
}

}  // namespace tanktread::deck
