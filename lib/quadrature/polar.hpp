#pragma once
// Rules for a target that lies on the element: the 1/r of a weakly singular integrand is taken up by the coordinates.

#include "quadrature/rule.hpp"

namespace tanktread::quadrature {

/// The metric at the target up to a factor, in bins, so that one rule serves many elements; what a bin is off by costs a point or two and
/// no accuracy: |x_,t|^2 / |x_,s|^2 is about 2^doublings, and the tangents meet at about `steps` times 15 degrees, 1 to 11.
struct Shear {
  int doublings = 0, steps = 6;

  double ratio() const;  ///< |x_,t| / |x_,s|
  double angle() const;
  auto operator<=>(const Shear&) const = default;
};

/// The bin of g_ab = x_,a . x_,b; the unit metric where that is not one.
Shear shear(double g_ss, double g_st, double g_tt);

/// Polar rule about (s, t) in the closed unit square: up to four triangles with their apex there, in the plane of
/// the metric `radial` Gauss points outwards and, in mu with arc coordinate h sinh(mu), so many angular ones that an integrand with
/// poles at mu = +- i pi / 2 (the directions in which r^2 = 0) keeps `tolerance`. Measured on deformed surfaces
/// (tests/verify/layers.cpp), the order must be the one for tolerance^1.25 exp(-range of mu / 2).
Rule polar(double s, double t, Shear shear, int radial, double tolerance);

/// The paper's rule: the same triangles in the parameter plane, n x n Gauss points each under Lachat and Watson's map.
Rule lachat_watson(double s, double t, int n);

}  // namespace tanktread::quadrature
