#pragma once
// What a rigid load does to its own body, between the collocation sites too.

#include <array>
#include <span>

#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"

namespace tanktread::coupling {

/// M^-1 int N_A A f dG - R^-1 A f of the loads f = e_k and e_k x r, k = 0, 1, 2, r from the centre of the volume: what collocation lacks of their
/// velocity on the surface itself, for a viscosity of 1. A spline surface of n elements a side is higher at its collocation sites than between them
/// by some 1/n^4, and outside of it the velocity of a load falls: collocated, a sphere that is turned by a load turns too slowly by 0.035 / n^4.
std::array<Net, 6> lacking_of_own_loads(const spline::Space& space, const Net& surface, const quadrature::Options& quadrature);

}  // namespace tanktread::coupling
