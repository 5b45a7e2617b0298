#pragma once
// Rules for a target that lies on the element: the 1/r of a weakly singular integrand is taken up by the coordinates.

#include "quadrature/rule.hpp"

namespace tanktread::quadrature {

/// The metric at the target up to a factor: |x_,t| / |x_,s| and the angle between the two tangents.
struct Shear {
  double ratio = 1, angle = 1.5707963267948966;

  /// The middle of the bin that this metric falls into: ratios in steps of sqrt(2), angles in steps of 15 degrees. Rules are made
  /// for bins, so that one rule serves many elements; what a bin is off by costs a point or two and no accuracy.
  Shear binned() const;
  auto operator<=>(const Shear&) const = default;
};

/// Polar rule about (s, t) in the closed unit square (splines.md, F.1): up to four triangles with their apex there, in the plane of
/// the metric `radial` Gauss points outwards and, in mu with arc coordinate h sinh(mu), so many angular ones that the error of an
/// integrand with poles at mu = +- i pi / 2 (the directions in which r^2 = 0) stays below `tolerance`.
Rule polar(double s, double t, const Shear& shear, int radial, double tolerance);

/// The paper's rule: the same triangles in the parameter plane, n x n Gauss points each under Lachat and Watson's map.
Rule lachat_watson(double s, double t, int n);

}  // namespace tanktread::quadrature
