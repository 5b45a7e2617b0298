#pragma once
// Input deck: merges files and single settings, reads them into options structs, and writes the effective deck, the manual and the JSON schema.

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/errors.hpp"
#include "deck/section.hpp"

namespace tanktread::deck {

struct Record;

/// A merged deck. Fills options structs by calling their function `declare`, and records the keys that they declare.
///
///   Document deck = read({"deck.yaml", "overlay.yaml"}, {"Time/final time=3"});
///   deck.declare(scene);                  // throws UserErrors that lists all wrong values, and unknown keys if every section was read
///   std::cout << deck.effective();        // YAML with the value of every key; read again, it gives the same scene bit for bit
class Document {
 public:
  explicit Document(std::shared_ptr<const Teuchos::ParameterList> given, bool documenting = false);

  /// Reads the value of every key that `options.declare` declares from the deck into `options`. Call it once per document.
  template <class Options>
  void declare(Options& options) {
    Section root = begin();
    try {
      options.declare(root);
    } catch (const UserError&) {
      refuse_wrong_values();  // throws the errors of refused values, if any: their keys keep the defaults, which may have caused this error
      throw;
    }
    finish();
  }

  /// Returns the effective deck as YAML text.
  std::string effective() const;

  /// Returns the values of all keys that are set, as texts by the path of the key.
  std::map<std::string, std::string> values() const;

  /// Returns the manual of all keys as Markdown.
  std::string reference() const;

  /// Returns a JSON schema (draft 7) of decks, for editors: types, choices, bounds and descriptions.
  std::string schema() const;

  /// Returns the given keys of the deck as YAML, with the description of each key in a comment above it.
  std::string commented() const;

 private:
  Section begin();
  void refuse_wrong_values() const;
  void finish() const;

  std::shared_ptr<const Teuchos::ParameterList> given_;
  bool documenting_;
  std::shared_ptr<Record> root_;
};

/// Reads and merges a deck, key by key. Each of `files` (XML if its name ends with .xml, otherwise YAML) overrides `stored` and the files before it.
/// `settings` (`Section/key=value`) override the files. `stored` is YAML text from a checkpoint and may be empty. Throws UserError.
///
/// An expectation (section Expect/<name>) is binding only for the deck that states it. It stops being binding if a later file, or the settings
/// together, change a key that affects results and set no key of the expectation. Its key `not binding` then names the changed keys. All keys affect
/// results except the keys of Output and Expect, and except Time/final time if the run still reaches the time `at` of the expectation. If `excuse` is
/// not empty, it becomes the value of `not binding` in all expectations.
Document read(const std::vector<std::string>& files, const std::vector<std::string>& settings, const std::string& stored = {},
              const std::string& excuse = {});

/// Reads a deck from YAML text. `origin` is the name of the deck in messages.
Document read_text(const std::string& yaml, const std::string& origin = "the deck");

/// Returns the manual of all keys that `options` declares.
template <class Options>
std::string manual(Options options) {
  Document document(nullptr, true);
  document.declare(options);
  return document.reference();
}

/// Returns the JSON schema of all keys that `options` declares.
template <class Options>
std::string schema(Options options) {
  Document document(nullptr, true);
  document.declare(options);
  return document.schema();
}

}  // namespace tanktread::deck
