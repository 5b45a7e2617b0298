#pragma once
// The line integrals of a cap (2.13) at one point, on plain arrays.

namespace tanktread::stokes {

/// Sums of rho.nu/r and nu/r over n nodes at (y, z) with normals times weights; rho is relative to (y0, z0), r^2 = rho^2 + h^2, and h is not 0.
struct CapSums {
  double flux, normal_y, normal_z;
};
CapSums cap_sums(int n, const double* y, const double* z, const double* normal_y, const double* normal_z, double h, double y0, double z0);

}  // namespace tanktread::stokes
