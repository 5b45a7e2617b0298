#pragma once
// The one statement of each parameter: key, default, rule, unit, meaning, beside the struct that uses it.
// From it come reading, checking, the effective deck and the manual (`--reference`).

#include <algorithm>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/types.hpp"
#include "deck/forward.hpp"

namespace tanktread::deck {

class Units;

/// What values a number may take: the test and its wording ("positive", "between 0 and 1").
struct Rule {
  std::string text;
  std::function<bool(double)> holds;
};
Rule any();
Rule positive();
Rule not_negative();
Rule at_least(double low);
Rule between(double low, double high);  ///< both ends included

/// What values a word may take. An empty list: any text.
using Choice = std::vector<std::string>;

/// One list of the deck, being read, checked or documented. An options struct states its keys once:
///
///   void Options::declare(deck::Section& s) {
///     s.key("tolerance", tolerance, deck::positive(), "1", "relative accuracy of every layer integral");
///     s.key("rule", rule, deck::Choice{"adaptive", "fixed"}, "how element integrals are taken");
///   }
///
/// The field's value before the call is the default. Throws UserError (path, rule, unit, given value) on a wrong value;
/// unknown keys are reported by the reader after all statements were made, with a guess of what was meant.
class Section {
 public:
  /// `Field`: a double, an int, three numbers, nine row by row, or one of these, two numbers, or a std::vector of any length, that is optional.
  template <class Field>
  void key(std::string_view name, Field& field, const Rule& rule, std::string_view unit, std::string_view meaning);

  /// Text, which may be optional.
  template <class Field>
  void key(std::string_view name, Field& field, const Choice& choice, std::string_view meaning);

  /// One of the words, for which the enumerators stand in their order.
  template <class Field>
    requires std::is_enum_v<Field>
  void key(std::string_view name, Field& field, const Choice& words, std::string_view meaning) {
    std::string word = words[static_cast<std::size_t>(field)];
    key(name, word, words, meaning);
    field = static_cast<Field>(std::find(words.begin(), words.end(), word) - words.begin());
  }

  void key(std::string_view name, bool& field, std::string_view meaning);

  /// A list inside this one, stated by `options.declare(Section&)`.
  template <class Options>
  void section(std::string_view name, Options& options, std::string_view meaning) {
    Section inner = enter(name, meaning);
    options.declare(inner);
  }

  /// A list that a deck may leave out, and whether it has it; what is left out stays as it is.
  template <class Options>
  bool optional_section(std::string_view name, Options& options, std::string_view meaning) {
    if (given(name) || documenting())
      section(name, options, meaning);
    else
      mention(name);
    return given(name);
  }

  /// A list handed to another library as it is (Belos, Amesos2, NOX); `field` keeps what the deck gives over its defaults.
  void foreign(std::string_view name, std::shared_ptr<Teuchos::ParameterList>& field, std::string_view meaning);

  /// From now on values in this list and those inside may have units.
  void take(std::shared_ptr<const Units> units);

  /// Names a list that this one may hold, and does not, in messages on names that it does not hold.
  void mention(std::string_view list);

  /// Lists whose names the user chooses (Expect/<name>): `use` is called with each name and its section. Those that are `alike` take what they do not
  /// say themselves from the list that their key `like` names, or from the one named `defaults`, which is none of them.
  void each(std::string_view meaning, const std::function<void(const std::string& name, Section&)>& use, bool alike = false);

  /// Whether the user gave this key (for contradictory alternatives), and its path for messages.
  bool given(std::string_view name) const;
  /// Leaves a key of a list of `each` out that the list does not set itself, but takes from `like` or `defaults`.
  void leave_out(std::string_view name);
  bool documenting() const;  ///< whether the manual is being made: then every list is stated
  std::string path(std::string_view name = {}) const;

  struct State;
  explicit Section(std::shared_ptr<State> state);

 private:
  Section enter(std::string_view name, std::string_view meaning);
  std::shared_ptr<State> state_;
};

}  // namespace tanktread::deck
