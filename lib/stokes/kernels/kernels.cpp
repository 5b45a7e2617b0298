#include "stokes/kernels/kernels.hpp"

#include <cmath>

namespace tanktread::stokes {

Mat3 stokeslet(const Vec3& r) {
  const double square = r.squaredNorm(), inverse = square > 0 ? 1 / std::sqrt(square) : 0;
  return inverse * Mat3::Identity() + inverse * inverse * inverse * r * r.transpose();
}

Mat3 stresslet(const Vec3& r, const Vec3& n) {
  const double square = r.squaredNorm();
  return -6 * r.dot(n) / (square * square * std::sqrt(square)) * r * r.transpose();
}

}  // namespace tanktread::stokes
