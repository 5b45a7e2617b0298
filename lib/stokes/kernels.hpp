#pragma once

#include "base/types.hpp"

namespace tanktread::stokes {

/// Free-space Stokeslet: velocity at x0 due to a unit point force at x, times 8 pi mu.
///
///   G_ij = delta_ij/|r| + r_i r_j/|r|^3,   r = x - x0                     (2.1)
///
/// Units 1/length. Pozrikidis 1992, eq. 2.2.8.
Mat3 stokeslet(const Vec3& r);

/// Stresslet contracted with a normal: T_ijk n_k = -6 r_i r_j (r.n)/|r|^5   (2.1). Units 1/length^2.
Mat3 stresslet(const Vec3& r, const Vec3& n);

/// Kernel evaluations done so far, by the kind of rule.
struct Evaluations {
  long long far = 0, near = 0, self = 0;
  long long total() const { return far + near + self; }
};

}  // namespace tanktread::stokes
