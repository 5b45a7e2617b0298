#pragma once
// Resistance of a membrane to bending, in the weak form; it needs a surface that is C1, geometrically, across every element side.

#include <vector>

#include "base/types.hpp"

namespace tanktread::membrane {

struct Part;
struct Materials;

/// E_b/2 int (2 chi - c0)^2 dGamma, chi = 1/2 div n: Helfrich's energy. The term with the Gaussian curvature is constant on a closed surface
/// and left out.
struct Bending {
  double modulus = 0;               ///< E_b, force x length; 0: no bending
  bool curved_when_relaxed = true;  ///< c0 is 2 chi of the unstressed surface, material point by material point; otherwise 0
};

void add_bending_energies(const Materials& materials, const Part& part, const Net& x, std::vector<double>& energy);

/// Adds its gradient, dE/dx_A, to d.
void add_bending_load(const Materials& materials, const Part& part, const Net& x, Net& d);

}  // namespace tanktread::membrane
