#pragma once
// A rule for a target that is near an element without lying on it: the element is bisected towards the target.

#include <algorithm>
#include <span>

#include "base/types.hpp"
#include "quadrature/gauss.hpp"

namespace tanktread::quadrature {

/// What an element integral must be worth: |error of int dG / r| <= `allowed` (units of length), or, for a kernel that is steeper by one
/// order, |error of int `steep` dG / r^2| <= `allowed` with a length `steep` > 0; and the relative accuracy that the smooth part of the
/// integrand (density, metric) needs, which `smooth_order` points reach on the whole element.
struct Demand {
  double allowed = 0, steep = 0, tolerance = 1e-5;
  int smooth_order = 4;

  /// What rho^(-2 n) may be on an area seen from a distance. The steeper kernel errs ten times as much at the same n.
  double error(double area, double distance) const {
    return allowed * distance / area * (steep > 0 ? 0.1 * std::min(1., distance / steep) : 1.);
  }
};

/// Adds to `rule` tensor Gauss rules on parts of the unit square, halved along the longer physical edge until moderate orders are
/// enough: the order of each direction from the Bernstein ellipse of the part.
/// `bezier`: Bezier points of the element, component c of point b at c (p + 1)^2 + b. A weight that is no number ends the rule of an element that is
/// not finite, or so crumpled that no reasonable number of parts is enough.
void graded(std::span<const double> bezier, int degree, const Vec3& target, const Demand& demand, Rule& rule);

}  // namespace tanktread::quadrature
