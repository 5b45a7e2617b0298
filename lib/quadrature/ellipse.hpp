#pragma once
// How many Gauss points: the integrand's nearest singularity z in the complex plane of [-1, 1], and the Bernstein ellipse through it.

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "base/types.hpp"

namespace tanktread::quadrature {

/// Sum of the semi-axes of the ellipse with foci -1 and 1 through z = re + i im: n Gauss points leave an error of rho^(-2 n).
inline double ellipse(double re, double im) {
  const double square = im * im, half = (std::sqrt((re - 1) * (re - 1) + square) + std::sqrt((re + 1) * (re + 1) + square)) / 2;
  return half + std::sqrt(std::max(0., half * half - 1));
}

/// Smallest n with rho^(-2 n) <= error, at least 1 and at most 1000.
inline int order_for(double error, double rho) {
  if (error >= 1) return 1;
  const double n = -std::log(error) / (2 * std::log(rho));
  return n < 1000 ? std::max(1, static_cast<int>(std::ceil(n))) : 1000;
}

/// A flat picture of an element or of a part of it: x = centre + a u + b v with a, b in [-1, 1].
struct Patch {
  Vec3 centre, u, v;

  double area() const { return 4 * u.cross(v).norm(); }
};

/// What a target is to a patch: its distance, and rho along u and along v at the place of the patch that is nearest.
struct Sight {
  double distance = 0, rho_u = 1, rho_v = 1;
};
Sight sight(const Patch& patch, const Vec3& target);

}  // namespace tanktread::quadrature
