#pragma once
// Singular quadrature, for a target that lies on the element. Polar coordinates cancel the 1/r of a weakly singular integrand.

#include <array>

#include "base/types.hpp"
#include "quadrature/gauss.hpp"

namespace tanktread::quadrature {

/// Metric at the target up to a factor, rounded to few values (bins), so that many elements share one quadrature rule. s and t are the local
/// coordinates of the element. |x_,t|^2 / |x_,s|^2 is about 2^doublings. The angle between the tangents x_,s and x_,t is about `steps` times 15
/// degrees, with `steps` from 1 to 11. With one or two more Gauss points, a rule for the rounded metric is as accurate as a rule for the exact
/// metric.
struct MetricBin {
  int doublings = 0, steps = 6;

  double ratio() const;  ///< returns |x_,t| / |x_,s|
  double angle() const;  ///< returns the angle between the tangents in radians
  auto operator<=>(const MetricBin&) const = default;
};

/// Returns the MetricBin nearest to the metric g_ab = x_,a . x_,b. If g is degenerate or not finite, returns the MetricBin of the unit metric.
MetricBin metric_bin(double g_ss, double g_st, double g_tt);

/// Numbers of Gauss points of a polar rule: in the radial direction, and in the angular direction over each side of the square (t = 0, s = 1, t = 1,
/// s = 0). The number is 0 for a side that contains the target.
struct PolarOrders {
  int radial = 0;
  std::array<int, 4> angular{};
  auto operator<=>(const PolarOrders&) const = default;
};

/// Returns the orders for a target at (s, t) of an element that is nearly affine. As a function of the angular coordinate mu, see polar(), the
/// integrand has poles at +- i pi / 2, where the squared distance r^2 vanishes. The angular order keeps the error due to these poles below
/// tolerance^1.25 exp(-m/2), with m the length of the interval of mu. This bound was found by measurements on deformed surfaces
/// (tests/verify/layers.cpp).
PolarOrders polar_orders(double s, double t, MetricBin bin, int radial, double tolerance);

/// Returns the orders for an element that is not affine. Estimates the poles of the integrand for the affine element and also from the actual
/// positions of the corners. Uses the poles that are closer to the interval of integration and require the larger orders. Both arrays hold the
/// corners (0, 0), (1, 0), (1, 1), (0, 1) relative to the target: `corner` the actual positions, `affine` the positions predicted by the tangents at
/// the target.
PolarOrders polar_orders(double s, double t, MetricBin bin, int radial, double tolerance, const std::array<Vec3, 4>& corner,
                         const std::array<Vec3, 4>& affine);

/// Returns the polar rule about (s, t) in the closed unit square. The square is divided into up to four triangles with apex (s, t). Lengths and
/// angles are measured with the metric `bin`. Each triangle has Gauss points in the radial coordinate and in an angular coordinate mu. If h is the
/// distance of the apex from the opposite side, h sinh(mu) is the arc length along this side from the foot of the perpendicular.
Rule polar(double s, double t, MetricBin bin, const PolarOrders& orders);

/// Returns the rule of Maestre et al. (2017): up to four triangles with apex (s, t) in the parameter plane, each with n x n Gauss points under the
/// map of Lachat and Watson.
Rule lachat_watson(double s, double t, int n);

}  // namespace tanktread::quadrature
