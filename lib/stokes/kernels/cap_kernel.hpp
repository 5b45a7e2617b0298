#pragma once
// Line integrals over the outline of a plane cap across a tube (2.13), for one target, on plain arrays.

namespace tanktread::stokes {

/// Sums of rho.nu/r and nu/r over n nodes (y, z) of an outline. nu is the normal of a node times its quadrature weight, rho = (y - y0, z - z0) and
/// r^2 = rho^2 + h^2. h is not 0.
struct CapSums {
  double flux, normal_y, normal_z;
};
CapSums cap_sums(int n, const double* y, const double* z, const double* normal_y, const double* normal_z, double h, double y0, double z0);

}  // namespace tanktread::stokes
