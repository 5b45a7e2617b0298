#include "surface/principal_axes.hpp"

#include <cmath>

#include <Eigen/Eigenvalues>

namespace tanktread::surface {

PrincipalAxes principal_axes(const Measures& measures) {
  const Eigen::SelfAdjointEigenSolver<Mat3> moments(measures.second_moments);  // ascending
  PrincipalAxes axes;
  for (int k = 0; k < 3; ++k) {
    axes.lengths[k] = std::sqrt(5 * moments.eigenvalues()[2 - k] / measures.volume);
    Vec3 direction = moments.eigenvectors().col(2 - k);
    for (double& component : direction)
      if (std::abs(component) < 1e-9) component = 0;  // rounding is not to choose the sense
    for (int c = 2; c >= 0; --c)
      if (direction[c] != 0) axes.directions.col(k) = std::copysign(1.0, direction[c]) * direction;
  }
  return axes;
}

}  // namespace tanktread::surface
