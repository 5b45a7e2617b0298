#pragma once
// Rules for a target that lies on the element: the 1/r of a weakly singular integrand is taken up by the coordinates.

#include <array>

#include "base/types.hpp"
#include "quadrature/gauss.hpp"

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

/// Gauss points of a polar rule: outwards, and around over each side of the square (t = 0, s = 1, t = 1, s = 0; 0 where the target is
/// on it).
struct PolarOrders {
  int radial = 0;
  std::array<int, 4> angular{};
  auto operator<=>(const PolarOrders&) const = default;
};

/// Orders for a target at (s, t) of an element that is nearly affine. In the angular coordinate mu of polar() the integrand has poles at
/// +- i pi / 2, the directions in which r^2 = 0. Measured on deformed surfaces (tests/verify/layers.cpp), the angular order must be the
/// one for tolerance^1.25 exp(-range of mu / 2).
PolarOrders polar_orders(double s, double t, Shear shear, int radial, double tolerance);

/// Raised where an element is so distorted that the corners it really has, seen from the target, bring poles nearer than those of its
/// tangents. Corners (0, 0), (1, 0), (1, 1), (0, 1) relative to the target: the real ones, and where the tangents put them.
PolarOrders polar_orders(double s, double t, Shear shear, int radial, double tolerance, const std::array<Vec3, 4>& corner,
                         const std::array<Vec3, 4>& affine);

/// Polar rule about (s, t) in the closed unit square: up to four triangles with their apex there, in the plane of the metric; Gauss points
/// outwards and in mu, where h sinh(mu) is the way along the far side and h its distance.
Rule polar(double s, double t, Shear shear, const PolarOrders& orders);

/// The paper's rule: the same triangles in the parameter plane, n x n Gauss points each under Lachat and Watson's map.
Rule lachat_watson(double s, double t, int n);

}  // namespace tanktread::quadrature
