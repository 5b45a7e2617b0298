#pragma once
// What the rule `desingularised` subtracts: integrals over a closed surface that are known to vanish.

namespace tanktread::stokes {

/// For the target x0 with normal n0 and the nodes x, y, z with normals times weights N:
///   pressure_i = sum G_ij N_j;   shear_ij = sum G_ij (n0.N) + (G n0)_i N_j - (n0.r) T_ijk N_k, row by row.
struct IdentitySums {
  double pressure[3], shear[9];
};
IdentitySums identity_sums(int n, const double* x, const double* y, const double* z, const double* nx, const double* ny, const double* nz,
                           const double* x0, const double* n0);

}  // namespace tanktread::stokes
