#pragma once
// Line integrals over the outline of a plane cap across a tube (2.13), for one target, on plain arrays.

namespace tanktread::stokes {

/// Sums of rho.nu/r (`flux`) and nu/r (`normal_y`, `normal_z`) over n nodes (y, z) of the outline of a cap. nu is the normal of a node times its
/// quadrature weight, rho = (y - y0, z - z0) and r^2 = rho^2 + h^2. The target is at (y0, z0), at the distance h from the plane of the cap. h must
/// not be 0.
struct CapSums {
  double flux, normal_y, normal_z;
};
CapSums cap_sums(int n, const double* y, const double* z, const double* normal_y, const double* normal_z, double h, double y0, double z0);

}  // namespace tanktread::stokes
