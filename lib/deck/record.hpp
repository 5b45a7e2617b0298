#pragma once
// Tree of all declared keys and sections of a deck. Section fills the tree; the effective deck, the manual and the schema are written from it.
// schema.cpp contains schema_text and commented_text, record.cpp the other functions.

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "deck/section.hpp"

namespace tanktread::deck {

/// Words for the size of a value that consists of numbers; empty if no value has this size. The index is ValueType::count.
inline constexpr std::array<std::string_view, 10> numbers_in_words{
    "one number or more", "a number", "two numbers", "three numbers", "", "", "", "", "", "nine numbers"};

/// Type of the value of a key. Messages, the manual and the schema are written from it.
struct ValueType {
  enum Kind { number, whole, truth, text };
  Kind kind;
  Rule rule = {};     ///< rule for each number
  int count = 1;      ///< how many numbers; 0 for one number or more
  Choice words = {};  ///< allowed texts; empty if any text is allowed
};

/// Returns a type of numbers in words. `brackets` follows the size if there are several numbers: `three numbers in brackets, each positive`.
std::string numbers_text(const ValueType& type, const std::string& brackets = {});

/// Returns a type in words for the manual: `positive`, `whole, at least 1`, `three numbers, each positive`, `text`.
std::string values_text(const ValueType& type);

/// Declaration and value of one key. Values are YAML text.
struct Entry {
  std::string key;
  std::string fallback;  ///< default value; empty if there is none
  ValueType type;
  std::string unit;
  std::string meaning;
  std::string value;  ///< value that was read; empty if not set
};

/// Declaration of one section of the deck.
struct Record {
  std::string name;
  std::string path;  ///< path of the section, `Flow` or `Expect/volume`; empty for the root
  std::string meaning;
  const Teuchos::ParameterList* given = nullptr;   ///< `merged` if it is set, otherwise the section in the deck; null if there is none
  const Teuchos::ParameterList* itself = nullptr;  ///< the section in the deck, without keys inherited through the key `like` or from `defaults`
  std::shared_ptr<Teuchos::ParameterList> merged;  ///< the section in the deck, with keys inherited through the key `like` or from `defaults`
  std::vector<Entry> entries;
  std::vector<std::unique_ptr<Record>> sections;
  std::vector<std::string> mistakes;                ///< one sentence per refused value; the key keeps its default
  std::vector<std::string> idle;                    ///< one sentence per key that is given but has no effect
  std::vector<std::string> unusual;                 ///< one sentence per given value of unusual size
  bool alike = false;                               ///< true if inner sections inherit keys through the key `like` or from `defaults`
  std::vector<std::string> mentioned;               ///< names that are allowed in this section although they are not declared
  std::shared_ptr<Teuchos::ParameterList> foreign;  ///< parameters passed to another library; null if this program reads the section

  std::string path_of(std::string_view key) const { return path.empty() ? std::string(key) : path + "/" + std::string(key); }
};

/// State of a Section: the record that it fills, whether the manual is being written (`documenting`), and the units of the deck (null if the deck
/// defines none). In the manual, sections whose names the user chooses are declared once, as `<name>`.
struct Section::State {
  Record* record;
  bool documenting;
  std::shared_ptr<const Units> units = {};
};

/// Returns the mistakes in a section, followed by the mistakes in its inner sections. A mistake in a key that several sections inherit is reported
/// once.
std::vector<std::string> mistakes(const Record& section);

/// Returns the sentences about keys without effect in a section and its inner sections, in the order of mistakes().
std::vector<std::string> idle_keys(const Record& section);

/// Returns the sentences about values of unusual size in a section and its inner sections, in the order of mistakes().
std::vector<std::string> unusual_values(const Record& section);

/// Returns a sentence for each key in a section or its inner sections that is given but not declared. The sentence suggests the closest key, which
/// may be in another section of `root`. An unknown key that several sections inherit is reported once.
std::vector<std::string> unknown_keys(const Record& section, const Record& root);

/// Returns the values of a section and its inner sections as YAML, indented by `depth` steps.
std::string yaml_text(const Record& section, int depth);

/// Returns the manual of a section and its inner sections as Markdown.
std::string markdown_text(const Record& section);

/// Returns the JSON schema of a section and its inner sections. Lines after the first are indented by `depth` steps.
std::string schema_text(const Record& section, int depth);

/// Returns the given keys of a section and its inner sections as YAML, with the description above each key. Keys that are not given are listed in a
/// comment with their defaults.
std::string commented_text(const Record& section, int depth);

}  // namespace tanktread::deck
