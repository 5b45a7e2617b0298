#pragma once

#include <optional>
#include <string>

#include "deck/forward.hpp"

namespace tanktread::membrane {

/// Options of the surfactant, `Interface/surfactant` of the deck. Concentrations c are divided by the uniform concentration at the start of the run.
struct SurfactantOptions {
  std::string equation_of_state = "linear";  ///< linear, Langmuir
  double elasticity = 0.2;                   ///< elasticity number E in the equation of state (3.16)
  std::optional<double> coverage;            ///< coverage x: initial concentration divided by the maximum packing concentration; only for Langmuir
  std::optional<double> diffusivity;         ///< surface diffusivity D_s, length^2/time; 0 if neither D_s nor the Peclet number is given
  std::optional<double> peclet_number;       ///< rate R_C^2/D_s

  void declare(deck::Section& section);

  /// Throws UserError, with a one-sentence message, if keys contradict each other or the surfactant removes all of the tension.
  void check() const;

  /// Returns the relative tension sigma(c)/sigma(0): 1 - E c, or 1 + E ln(1 - x c) with the coverage x. The result is not positive, or NaN, if no
  /// tension is left. (3.16)
  double tension(double c) const;

  /// Returns the derivative of tension(c).
  double tension_slope(double c) const;

  /// Returns f(c)/sigma(0), with f the free energy density of the surface, sigma = f - c f' (3.21).
  double free_energy(double c) const;

  /// Returns the surface diffusivity D_s. `rate`: rate of the flow, `radius`: particle radius R_C.
  double diffusivity_of(double rate, double radius) const;
};

}  // namespace tanktread::membrane
