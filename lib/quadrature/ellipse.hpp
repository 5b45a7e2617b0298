#pragma once
// Number of Gauss points for an integrand on [-1, 1], from the Bernstein ellipse through its nearest singularity z in the complex plane.

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "base/types.hpp"

namespace tanktread::quadrature {

/// Returns rho, the sum of the semi-axes of the ellipse with foci -1 and 1 through the point z = re + i im (Bernstein ellipse). The error of n Gauss
/// points is about rho^(-2 n) if z is the nearest singularity.
inline double ellipse(double re, double im) {
  const double square = im * im, half = (std::sqrt((re - 1) * (re - 1) + square) + std::sqrt((re + 1) * (re + 1) + square)) / 2;
  return half + std::sqrt(std::max(0., half * half - 1));
}

/// Returns the smallest number n of Gauss points with rho^(-2 n) <= error, at least 1 and at most 1000.
inline int order_for(double error, double rho) {
  if (error >= 1) return 1;
  const double n = -std::log(error) / (2 * std::log(rho));
  return n < 1000 ? std::max(1, static_cast<int>(std::ceil(n))) : 1000;
}

/// Planar approximation of an element or of a part of it: x = centre + a u + b v with a, b in [-1, 1].
struct Patch {
  Vec3 centre, u, v;

  double area() const { return 4 * u.cross(v).norm(); }
};

/// Data of a patch seen from a target. distance: from the target to the nearest point of the patch. rho_u, rho_v: parameters of the Bernstein
/// ellipses of 1/r along the directions u and v through this point.
struct Sight {
  double distance = 0, rho_u = 1, rho_v = 1;
};
/// Returns the distance of a target from a patch, and the parameters rho_u and rho_v of the Bernstein ellipses of 1/r.
Sight sight(const Patch& patch, const Vec3& target);

}  // namespace tanktread::quadrature
