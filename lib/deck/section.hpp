#pragma once
// Declaration of deck keys: name, default, rule, unit and description. Each parameter is declared only once, by the struct that uses it. Reading,
// checking, the effective deck and the manual (`--reference`) all use this declaration.

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "base/types.hpp"
#include "deck/forward.hpp"
#include "deck/table.hpp"

namespace tanktread::deck {

class Units;

/// Rule for the values of a number: its wording ("positive", "between 0 and 1"), the bounds, which are also in the schema, and any other test.
struct Rule {
  std::string text;
  std::function<bool(double)> test = {};  ///< test in addition to the bounds; may be empty
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
  bool open = false;  ///< true if the number must not be equal to `low`

  bool holds(double x) const { return (open ? x > low : x >= low) && x <= high && (!test || test(x)); }
};
Rule any();
Rule positive();
Rule not_negative();
Rule at_least(double low);
Rule between(double low, double high);  ///< both ends included

/// Allowed values of a text. If empty, any text is allowed.
using Choice = std::vector<std::string>;

/// Returns the word for an enumerator. `words` are in the order of the enumerators.
template <class Enumeration>
const std::string& word(const Choice& words, Enumeration enumerator) {
  return words[static_cast<std::size_t>(enumerator)];
}

/// A section (YAML mapping) of the deck, which is being read, checked or documented. An options struct declares its keys once:
///
///   void Options::declare(deck::Section& s) {
///     s.key("tolerance", tolerance, deck::positive(), "1", "relative accuracy of every layer integral");
///     s.key("rule", rule, deck::Choice{"adaptive", "fixed"}, "how element integrals are taken");
///   }
///
/// The value of the field before the call is the default. If the given value is wrong, the field keeps its default, and Document::declare later
/// throws UserError (path, rule, unit, given value). Document::declare also reports unknown keys, and suggests the closest key for each.
class Section {
 public:
  /// Declares a key whose value is one number or several. `Field`: double, int, Vec3, Mat3 (nine numbers row by row) or std::optional of one of these
  /// types; also std::optional of Eigen::Vector2d or std::vector<double> (any length).
  template <class Field>
  void key(std::string_view name, Field& field, const Rule& rule, std::string_view unit, std::string_view meaning);

  /// Declares a key whose value is text. `Field`: std::string or std::optional<std::string>.
  template <class Field>
  void key(std::string_view name, Field& field, const Choice& choice, std::string_view meaning);

  /// Declares a key whose value is an enumerator; if `field` is optional, the key need not have a value. `words` are the words for the enumerators in
  /// their order.
  template <class Field>
    requires std::is_enum_v<Field>
  void key(std::string_view name, std::optional<Field>& field, const Choice& words, std::string_view meaning) {
    std::optional<std::string> text;
    if (field) text = word(words, *field);
    key(name, text, words, meaning);
    if (text) field = static_cast<Field>(std::find(words.begin(), words.end(), *text) - words.begin());
  }
  template <class Field>
    requires std::is_enum_v<Field>
  void key(std::string_view name, Field& field, const Choice& words, std::string_view meaning) {
    std::optional<Field> value = field;
    key(name, value, words, meaning);
    field = *value;
  }

  void key(std::string_view name, bool& field, std::string_view meaning);

  /// Declares a key whose value is the path of a table.
  void key(std::string_view name, std::optional<TableFile>& field, std::string_view meaning);

  /// States that the keys `names`, which are declared before, have no effect `because` of another choice ("with Time/scheme `bs3`"). A key to which
  /// the deck gives another value than the default is then listed by idle_keys().
  void without_effect(const std::vector<std::string>& names, const std::string& because);
  void without_effect_except(const std::string& name, const std::string& because);  ///< without_effect() for all declared keys but `name`
  std::vector<std::string> idle_keys() const;  ///< one sentence per key without effect that the deck sets, also in inner sections

  /// Returns one sentence per given value, also in inner sections, that is a thousand times smaller or larger than usual; none without units.
  std::vector<std::string> unusual_values() const;

  /// Declares a section inside this one by calling `options(Section&)` if `options` is a function, and otherwise `options.declare(Section&)`.
  template <class Options>
  void section(std::string_view name, Options&& options, std::string_view meaning) {
    Section inner = enter(name, meaning);
    if constexpr (std::is_invocable_v<Options&, Section&>) options(inner);
    else options.declare(inner);
  }

  /// Declares a section that a deck may leave out. Returns whether the deck has it. If not, `options` does not change.
  template <class Options>
  bool optional_section(std::string_view name, Options&& options, std::string_view meaning) {
    if (given(name) || documenting())
      section(name, options, meaning);
    else
      mention(name);
    return given(name);
  }

  /// Declares a section that is passed to another library (Belos, Amesos2, NOX) without checks. The given keys override the defaults in `field`.
  void foreign(std::string_view name, std::shared_ptr<Teuchos::ParameterList>& field, std::string_view meaning);

  /// Sets the units of the deck. Afterwards, values in this section and in sections that are later declared inside it may have units.
  void take(std::shared_ptr<const Units> units);

  /// Allows a name in this section that is not declared. Messages about unknown keys list this name among the allowed names.
  void mention(std::string_view name);

  /// Declares sections whose names the user chooses (Expect/<name>), by calling `use` with each name and its section. If `alike`, keys that a section
  /// does not set are taken from the section named by its key `like`, or from the section `defaults` if it has no key `like`. `use` is not called for
  /// `defaults`. If `alike` is false, the sections do not share keys.
  void each(std::string_view meaning, const std::function<void(const std::string& name, Section&)>& use, bool alike = false);

  /// Returns whether the user gave this key. Used to detect keys that contradict each other.
  bool given(std::string_view name) const;
  /// Removes a key that this section takes from `like` or `defaults` (see `each`). A key that the section sets itself stays.
  void leave_out(std::string_view name);
  bool documenting() const;                            ///< returns whether the manual is being made; if so, every section must be declared
  std::string path(std::string_view name = {}) const;  ///< returns the path of a key, or of this section, for messages

  struct State;
  explicit Section(std::shared_ptr<State> state);

 private:
  Section enter(std::string_view name, std::string_view meaning);
  std::shared_ptr<State> state_;
};

}  // namespace tanktread::deck
