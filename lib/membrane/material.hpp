#pragma once
// What membranes are made of.

#include <vector>

#include "membrane/laws.hpp"

namespace tanktread::membrane {

/// E_b/2 int (2 chi - c0)^2 dGamma, chi = 1/2 div n: Helfrich's energy, in the weak form. It needs a surface that is C1, geometrically, across every
/// element side. The term with the Gaussian curvature is constant on a closed surface and left out.
struct Bending {
  double modulus = 0;               ///< E_b, force x length; 0: no bending
  bool curved_when_relaxed = true;  ///< c0 is 2 chi of the unstressed surface, material point by material point; otherwise 0
};

struct Material {
  Law law;
  Bending bending;
};

/// The materials of a surface, and which of them each element is of.
struct Materials {
  std::vector<Material> all;
  std::vector<int> of_element;  ///< none where there is one material
};

}  // namespace tanktread::membrane
