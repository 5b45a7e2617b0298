#pragma once
// Sums for the quadrature rule `desingularised` (see Layer), for one target, on plain arrays.

namespace tanktread::stokes {

/// Sums over the nodes (x, y, z) for a target x0 with the normal n0, for the two identities of the quadrature rule `desingularised` (see Layer). N =
/// (nx, ny, nz) is the normal of a node times its quadrature weight, and r is the vector from the target to the node:
///   pressure_i = sum G_ij N_j;   shear_ij = sum G_ij (n0.N) + (G n0)_i N_j - (n0.r) T_ijk N_k, row by row.
struct IdentitySums {
  double pressure[3], shear[9];
};
IdentitySums identity_sums(int n, const double* x, const double* y, const double* z, const double* nx, const double* ny, const double* nz,
                           const double* x0, const double* n0);

}  // namespace tanktread::stokes
