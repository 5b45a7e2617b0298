#include "motion/stiffness.hpp"

#include <cmath>
#include <random>

namespace tanktread::motion {

namespace {

/// Rough, so that every mode is in it.
Net random_direction(Eigen::Index rows) {
  std::minstd_rand generator(1);  // the same numbers from every library
  Net direction(rows, 3);
  for (Eigen::Index i = 0; i < rows; ++i)
    for (Eigen::Index c = 0; c < 3; ++c) direction(i, c) = static_cast<double>(generator()) / std::minstd_rand::max() - 0.5;
  return direction;
}

}  // namespace

double stiffness(coupling::Dynamics& dynamics, const Net& x, const Net& v, Net& direction, int iterations) {
  if (direction.rows() != x.rows()) direction = random_direction(x.rows());
  direction /= dynamics.norm(direction);
  double rho = 0;
  for (int k = 0; k < iterations; ++k) {
    const Net image = dynamics.derivative(x, v, direction);
    rho = dynamics.norm(image);
    if (!(rho > 0) || !std::isfinite(rho)) return rho;
    direction = image / rho;
  }
  return rho;
}

}  // namespace tanktread::motion
