#pragma once

#include <optional>
#include <string>

#include "deck/forward.hpp"

namespace tanktread::membrane {

/// `Interface/surfactant` of the deck. Concentrations c are over the uniform one that the run starts with.
struct SurfactantOptions {
  std::string equation_of_state = "linear";  ///< linear, Langmuir
  double elasticity = 0.2;                   ///< E of the equation of state
  std::optional<double> coverage;            ///< x of Langmuir's: the initial concentration over the largest one; given for this one alone
  std::optional<double> diffusivity;         ///< D_s, length^2/time; 0 if neither is given
  std::optional<double> peclet_number;       ///< rate R_C^2/D_s

  void declare(deck::Section& section);

  /// One sentence (UserError) for keys that contradict each other, or a surfactant that takes all of the tension away.
  void check() const;

  /// sigma(c)/sigma(0): 1 - E c, or 1 + E ln(1 - x c); not above 0, or not a number, where there is no tension left.            (3.16)
  double tension(double c) const;

  /// Derivative of tension(c).
  double tension_slope(double c) const;

  /// f(c)/sigma(0) of the free energy f of the surface with sigma = f - c f' (3.21).
  double free_energy(double c) const;

  /// D_s; `rate` of the flow, `radius` R_C.
  double diffusivity_of(double rate, double radius) const;
};

}  // namespace tanktread::membrane
