#include "stokes/kernels/cap_kernel.hpp"

#include <cmath>

#include "base/kernel.hpp"

namespace tanktread::stokes {
namespace INSTRUCTIONS {

CapSums cap_sums(int n, const double* y, const double* z, const double* normal_y, const double* normal_z, double h, double y0, double z0) {
  double flux = 0, sum_y = 0, sum_z = 0;
  for (int k = 0; k < n; ++k) {
    const double dy = y[k] - y0, dz = z[k] - z0, inverse = 1 / std::sqrt(dy * dy + dz * dz + h * h);
    flux += (dy * normal_y[k] + dz * normal_z[k]) * inverse;
    sum_y += normal_y[k] * inverse;
    sum_z += normal_z[k] * inverse;
  }
  return {flux, sum_y, sum_z};
}

}  // namespace INSTRUCTIONS

KERNEL(CapSums, cap_sums,
       (int n, const double* y, const double* z, const double* normal_y, const double* normal_z, double h, double y0, double z0),
       (n, y, z, normal_y, normal_z, h, y0, z0))

}  // namespace tanktread::stokes
