#pragma once
// Near-singular quadrature, for a target that is close to an element but not on it. The element is bisected towards the target.

#include <algorithm>
#include <span>

#include "base/types.hpp"
#include "quadrature/gauss.hpp"

namespace tanktread::quadrature {

/// Accuracy that an element integral must have: |error of int dG / r| <= `allowed` (a length), or for a kernel that is steeper by one order,
/// |error of int `steep` dG / r^2| <= `allowed` with a length `steep` > 0. `tolerance` is the relative accuracy of the smooth part of the integrand
/// (density, metric), which `smooth_order` points reach on the whole element.
struct Demand {
  double allowed = 0, steep = 0, tolerance = 1e-5;
  int smooth_order = 4;

  /// Returns the largest error rho^(-2 n) of n Gauss points that is allowed on a part of the element with this area at this distance from the target.
  /// For the kernel 1/r^2 (`steep` > 0), the error is taken as ten times as large as rho^(-2 n).
  double error(double area, double distance) const {
    return allowed * distance / area * (steep > 0 ? 0.1 * std::min(1., distance / steep) : 1.);
  }
};

/// Adds to `rule` tensor Gauss rules on parts of the unit square. A part is bisected along its longer physical edge until moderate orders are enough.
/// The order in each direction follows from the Bernstein ellipse of the part.
/// `bezier`: Bezier points of the element, component c of point b at c (p + 1)^2 + b. If the element is not finite, or so crumpled that no reasonable
/// number of parts is enough, the last weight of the rule is NaN.
void graded(std::span<const double> bezier, int degree, const Vec3& target, const Demand& demand, Rule& rule);

}  // namespace tanktread::quadrature
