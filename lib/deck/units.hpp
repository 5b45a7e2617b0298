#pragma once
// Conversion of values with units, `5.3 uN/m`, by the library UDUNITS.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tanktread::deck {

class Section;
struct Dimension;
struct Quantity;

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

  /// Returns the value of `text`, a number with or without a unit (see quantity()), in the deck's units. Throws std::invalid_argument if `text` is
  /// not a number or the unit is not of this kind; the message completes a sentence that begins with `text`, and names units that work. Units of
  /// angles belong only to the kinds `degree`, `degrees` and `radian/time`.
  double number(const std::string& text, std::string_view kind) const;

  /// Returns the end of a sentence about a value that is a thousand times smaller or larger than usual values of this kind; empty for other values
  /// and for 0. `number`: size of the value in the deck's units. `coordinate`: true if any small value is usual.
  std::string unusual(std::string_view kind, double number, bool coordinate = false) const;

  /// Returns a quantity of this kind as text in SI units, for example `1e-06 N/m`. `number`: value in the deck's units. The text is empty if the kind
  /// is dimensionless.
  std::string in_si(std::string_view kind, double number = 1) const;

  /// Returns the units of the deck in SI units, for the plan.
  std::string description() const;

 private:
  std::string scaled(std::string_view kind) const;
  bool is_spelled(const std::string& unit) const;               ///< whether the unit is a product of words that UDUNITS knows
  const Dimension* dimension(std::string_view kind) const;      ///< usual units and values of this kind; null for other kinds
  std::vector<std::string> alike(const std::string& unit, std::string_view kind) const;  ///< usual units that differ only in capitals, or not at all
  std::string reason(const Quantity& given, std::string_view kind) const;  ///< why the unit of a quantity does not fit the kind, and units that fit

  std::shared_ptr<void> system_;
  UnitOptions options_;
};

}  // namespace tanktread::deck
