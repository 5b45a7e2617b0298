#pragma once
// What has been stated about a deck: the tree of keys, filled by Section, read by the effective deck and the manual.

#include <memory>
#include <string>
#include <vector>

#include "deck/section.hpp"

namespace tanktread::deck {

/// One key as it was stated, everything as text.
struct Entry {
  std::string key;
  std::string fallback;  ///< its default; empty: none
  std::string values;    ///< its rule
  std::string unit;
  std::string meaning;
  std::string value;  ///< in YAML, as it stands after reading; empty: not set
};

/// One list of the deck as it was stated.
struct List {
  std::string name;
  std::string path;  ///< `Flow`, `Expect/volume`; empty for the root
  std::string meaning;
  const Teuchos::ParameterList* given = nullptr;  ///< what the user gave for it, or nothing
  const Teuchos::ParameterList* itself = nullptr;  ///< what the user gave for it, without what it shares with other lists
  std::shared_ptr<Teuchos::ParameterList> merged;  ///< that with what it shares with other lists, where it does
  std::vector<Entry> entries;
  std::vector<std::unique_ptr<List>> lists;
  std::vector<std::string> mistakes;   ///< a sentence for each value that is refused; its key keeps the default
  bool alike = false;                  ///< whether lists in this one share keys by `like` and `defaults`
  std::vector<std::string> mentioned;  ///< names of lists that may stand here, but do not
  std::shared_ptr<Teuchos::ParameterList> foreign;  ///< set when the list belongs to another library

  std::string path_of(std::string_view key) const { return path.empty() ? std::string(key) : path + "/" + std::string(key); }
};

/// The list that a section writes to, whether a manual is being made (then open lists are stated once, as `<name>`), and what its values' units are
/// taken by, if the deck says.
struct Section::State {
  List* list;
  bool documenting;
  std::shared_ptr<const Units> units = {};
};

/// The mistakes of a list and all below, each list's own first. What lists that share keys have in common is told once.
std::vector<std::string> mistakes(const List& list);

/// A sentence for each key of the user's that nobody has stated, with a guess of what was meant. `root` for keys of other lists. The same holds.
std::vector<std::string> unknown_keys(const List& list, const List& root);

/// The values of a list and all below as YAML, indented by `depth` steps.
std::string yaml_text(const List& list, int depth);

/// The statements of a list and all below as Markdown.
std::string markdown_text(const List& list);

/// The same as a JSON schema, of which the lines after the first are indented by `depth` steps.
std::string schema_text(const List& list, int depth);

/// The keys of a list and all below that are given, in YAML, each under its meaning, and the names of those that are not.
std::string commented_text(const List& list, int depth);

}  // namespace tanktread::deck
