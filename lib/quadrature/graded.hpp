#pragma once
// Near-singular quadrature, for a target that is close to an element but not on it. The element is bisected towards the target.

#include <algorithm>
#include <span>

#include "base/types.hpp"
#include "quadrature/gauss.hpp"

namespace tanktread::quadrature {

/// Required accuracy of an integral over an element. dA is the area element, and r is its distance from the target. For the kernel 1/r (`steep` = 0):
/// |error of int dA / r| <= `allowed`, a length. For the kernel 1/r^2 (`steep` > 0, a length): |error of int `steep` dA / r^2| <= `allowed`. The
/// smooth factors of the integrand (density, metric) are integrated to the relative accuracy `tolerance` by `smooth_order` Gauss points on the whole
/// element.
struct Demand {
  double allowed = 0, steep = 0, tolerance = 1e-5;
  int smooth_order = 4;

  /// Returns the largest permitted rho^(-2 n) of n Gauss points, for a part of the element with this area at this distance from the target. The error
  /// of the points is taken as rho^(-2 n) for the kernel 1/r, and as 10 rho^(-2 n) for the kernel 1/r^2 (`steep` > 0).
  double error(double area, double distance) const {
    return allowed * distance / area * (steep > 0 ? 0.1 * std::min(1., distance / steep) : 1.);
  }
};

/// Adds to `rule` tensor Gauss rules on parts of the unit square. A part is bisected along its longer physical edge until moderate orders are enough.
/// The order in each direction follows from the Bernstein ellipse of the part. `bezier`: Bezier points of the element, component c of point b at
/// index c (p + 1)^2 + b, with the degree p. If the element is not finite, or so crumpled that no reasonable number of parts is enough, the last
/// weight of the rule is NaN.
void graded(std::span<const double> bezier, int degree, const Vec3& target, const Demand& demand, Rule& rule);

}  // namespace tanktread::quadrature
