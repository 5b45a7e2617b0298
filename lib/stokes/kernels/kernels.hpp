#pragma once
// Free-space kernels for one pair of points, and the number of kernel evaluations.

#include <cmath>
#include <numbers>

#include "base/types.hpp"

namespace tanktread::stokes {

/// Factor 1/(8 pi) of the single-layer and double-layer integrals (2.1), (2.2).
constexpr double over_8_pi = 1 / (8 * std::numbers::pi);

/// Returns the free-space Stokeslet: velocity at x0 due to a unit point force at x, times 8 pi mu.
///
///   G_ij = delta_ij/|r| + r_i r_j/|r|^3,   r = x - x0                     (2.1)
///
/// Zero at r = 0. Units 1/length. Pozrikidis 1992, eq. 2.2.8.
inline Mat3 stokeslet(const Vec3& r) {
  const double square = r.squaredNorm(), inverse = square > 0 ? 1 / std::sqrt(square) : 0;
  return inverse * Mat3::Identity() + inverse * inverse * inverse * r * r.transpose();
}

/// Returns the stresslet contracted with a normal: T_ijk n_k = -6 r_i r_j (r.n)/|r|^5   (2.1). Zero at r = 0. Units 1/length^2.
inline Mat3 stresslet(const Vec3& r, const Vec3& n) {
  const double square = r.squaredNorm();
  if (square == 0) return Mat3::Zero();
  return -6 * r.dot(n) / (square * square * std::sqrt(square)) * r * r.transpose();
}

/// Number of kernel evaluations so far, by the kind of rule: far-field, near-singular and singular.
struct Evaluations {
  long long far = 0, near = 0, self = 0;
  long long total() const { return far + near + self; }
  Evaluations& operator+=(const Evaluations& other) {
    far += other.far, near += other.near, self += other.self;
    return *this;
  }
  friend Evaluations operator+(Evaluations one, const Evaluations& other) { return one += other; }
};

}  // namespace tanktread::stokes
