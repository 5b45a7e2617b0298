#pragma once
// Local knots of an anchor, and one cubic B-spline on one interval.

#include "spline/t_mesh.hpp"

namespace tanktread::spline {

/// In each slot of an anchor, the distances (lattice units) to the first and second perpendicular touch. A ray that runs into an extraordinary
/// point first gets d, 2 d (mirror: the rings there are uniform), and so does every slot of such a point. Beyond the border of an open face the
/// end knot is repeated. Parametric distances: Lattice::length.
struct Knots {
  int reach[4][2];
};
Knots knots(const TMesh& mesh, int anchor);

/// Bernstein coefficients on [a, b] of the cubic B-spline with knots k0 <= .. <= k4, none of them strictly inside [a, b] in [k0, k4]:
/// coefficient i is the blossom f(a, .., a, b, .., b) with i times b.
std::array<double, 4> b_spline_on(const std::array<double, 5>& k, double a, double b);

}  // namespace tanktread::spline
