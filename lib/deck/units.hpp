#pragma once
// Values with units, `5.3 uN/m`, by UDUNITS.

#include <memory>
#include <string>
#include <string_view>

namespace tanktread::deck {

class Section;

/// What one unit of length, time and force in the deck's plain numbers, and in all results, stands for. As preset, a stress is in Pa, a modulus of a
/// surface in uN/m, a viscosity in Pa s.
struct UnitOptions {
  std::string length = "1 um", time = "1 s", force = "1 pN";

  void declare(Section& section);
};

/// Conversions between units with names and the deck's own. A `kind` is the unit of a key or of a series in the deck's words: `force/length`.
class Units {
 public:
  /// Throws UserError where a text is no length, time or force.
  explicit Units(const UnitOptions& options);

  /// The number in the deck's units that `text`, a number and a unit or a plain number, stands for. Throws std::invalid_argument, with the rest of a
  /// sentence on `text`, where it is not of this kind.
  double number(const std::string& text, std::string_view kind) const;

  /// So many of this kind in SI units, `1e-06 N/m`; of a number without dimension nothing.
  std::string in_si(std::string_view kind, double number = 1) const;

  /// What the deck's units are, for the plan.
  std::string description() const;

 private:
  std::string scaled(std::string_view kind) const;

  std::shared_ptr<void> system_;
  UnitOptions options_;
};

}  // namespace tanktread::deck
