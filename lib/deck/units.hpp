#pragma once
// Conversion of values with units, `5.3 uN/m`, by the library UDUNITS.

#include <memory>
#include <string>
#include <string_view>

namespace tanktread::deck {

class Section;

/// Units of length, time and force of the plain numbers in the deck and of all results. With the defaults, the unit of stress is Pa, the unit of
/// surface moduli is uN/m, and the unit of viscosity is Pa s.
struct UnitOptions {
  std::string length = "1 um", time = "1 s", force = "1 pN";

  void declare(Section& section);
};

/// Converts between named units and the units of the deck. A `kind` is the unit of a key or a series in terms of the units of the deck, for example
/// `force/length`.
class Units {
 public:
  /// Message of number() for keys whose values have no unit, or the unit of another choice of the deck.
  static constexpr std::string_view plain = "has a unit where a plain number belongs";

  /// Throws UserError if the option `length`, `time` or `force` is not a quantity of this dimension, or if UDUNITS finds no table of units.
  explicit Units(const UnitOptions& options);

  /// Returns the value of `text`, a number with or without a unit, in the deck's units. Throws std::invalid_argument if `text` is not a number or the
  /// unit is not of this kind; the message completes a sentence that begins with `text`.
  double number(const std::string& text, std::string_view kind) const;

  /// Returns a quantity of this kind as text in SI units, for example `1e-06 N/m`. `number`: value in the deck's units. The text is empty if the kind
  /// is dimensionless.
  std::string in_si(std::string_view kind, double number = 1) const;

  /// Returns the units of the deck in SI units, for the plan.
  std::string description() const;

 private:
  std::string scaled(std::string_view kind) const;

  std::shared_ptr<void> system_;
  UnitOptions options_;
};

}  // namespace tanktread::deck
