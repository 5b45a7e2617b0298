#pragma once
// A rule for a target that is near an element without lying on it: the element is bisected towards the target.

#include <span>

#include "base/types.hpp"
#include "quadrature/rule.hpp"

namespace tanktread::quadrature {

/// What an element integral must be worth: |error of int dG / r| <= `allowed` (units of length), and the relative accuracy that the
/// smooth part of the integrand (density, metric) needs, which `smooth_order` points reach on the whole element.
struct Demand {
  double allowed = 0, tolerance = 1e-5;
  int smooth_order = 4;
};

/// Adds to `rule` tensor Gauss rules on parts of the unit square, halved along the longer physical edge until moderate orders are
/// enough: the order of each direction from the Bernstein ellipse of the part.
/// `bezier`: Bezier points of the element, component c of point b at c (p + 1)^2 + b.
void graded(std::span<const double> bezier, int degree, const Vec3& target, const Demand& demand, Rule& rule);

}  // namespace tanktread::quadrature
