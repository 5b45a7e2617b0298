#pragma once
// A deck as it was given: files one over the other, single keys over them; and what comes from holding it against the statements of the keys.

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/errors.hpp"
#include "deck/section.hpp"

namespace tanktread::deck {

/// A deck: reads into options structs by their `declare`, and keeps what they stated.
///
///   Document deck = read({"deck.yaml", "overlay.yaml"}, {"Time/final time=3"});
///   deck.declare(scene);                  // throws UserErrors with all wrong values, and unknown keys if all were read
///   std::cout << deck.effective();        // YAML with the value of every key; read again, it gives the same scene bit for bit
class Document {
 public:
  explicit Document(std::shared_ptr<Teuchos::ParameterList> given, bool documenting = false);
  ~Document();
  Document(Document&&) noexcept;

  /// Reads every key that `options` states; once for one document.
  template <class Options>
  void declare(Options& options) {
    Section root = begin();
    try {
      options.declare(root);
    } catch (const UserError&) {
      refuse_wrong_values();  // the error may follow from a default that stands for a wrong value
      throw;
    }
    finish();
  }

  /// The effective deck as YAML text.
  std::string effective() const;

  /// The value of every key that is set, as text, by path.
  std::map<std::string, std::string> values() const;

  /// The manual of every key as Markdown.
  std::string reference() const;

  /// A JSON schema (draft 7) of decks, for editors: types, choices, bounds and meanings.
  std::string schema() const;

  /// The deck as it was given, each key under its meaning.
  std::string commented() const;

 private:
  Section begin();
  void refuse_wrong_values() const;
  void finish() const;
  struct Held;
  std::unique_ptr<Held> held_;
};

/// The deck in `files` (YAML, or XML by extension), later ones over earlier ones key by key, then each `Section/key=value` of `settings`.
/// `stored` (YAML text, of a checkpoint) lies under all of them; it may be empty. Throws UserError.
///
/// An expectation binds what it was stated for: where a later file, or the settings together, give another value to a key that results depend on
/// (all but those of Output and Expect, and Time/final time where it comes after the expectation's `at`), and do not state a key of Expect/<name>
/// again, `not binding` of that expectation names the keys. `excuse`, if it is not empty, is `not binding` of all.
Document read(const std::vector<std::string>& files, const std::vector<std::string>& settings, const std::string& stored = {},
              const std::string& excuse = {});

/// A deck from its YAML text; `origin` names it in messages.
Document read_text(const std::string& yaml, const std::string& origin = "the deck");

/// The manual of everything that `options` states.
template <class Options>
std::string manual(Options options) {
  Document document(nullptr, true);
  document.declare(options);
  return document.reference();
}

/// The schema of everything that `options` states.
template <class Options>
std::string schema(Options options) {
  Document document(nullptr, true);
  document.declare(options);
  return document.schema();
}

}  // namespace tanktread::deck
