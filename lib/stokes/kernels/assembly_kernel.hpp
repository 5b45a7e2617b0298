#pragma once
// Far-field part of assembled rows: moments of the kernel with the basis functions of one panel, for sixteen targets at a time.

#include <cstdint>

namespace tanktread::stokes {

constexpr int assembly_block = 16;  ///< number of targets that are processed together in one pass
constexpr int assembly_tile = 4;    ///< the number of basis functions is padded to a multiple of this number

/// One panel with its far nodes. `x`, `y`, `z`: positions. `weight`: weights including the area, for the single layer; if null, `normal` has the
/// normals times these weights, for the double layer. basis[n_nodes A + k]: value of basis function A = 0 .. functions - 1 at node k. `rows`: row of
/// `sums` to which each function adds.
template <class Real>
struct PanelNodes {
  int n_nodes = 0, functions = 0;
  const double *x = nullptr, *y = nullptr, *z = nullptr;
  const double* weight = nullptr;  ///< weights of the single layer
  const double* normal[3] = {};    ///< normals at the nodes for the double layer, used if `weight` is null
  const Real* basis = nullptr;
  const int* rows = nullptr;
};

/// Adds sum_k G_c(x_k, x0_l) N_A(x_k) w_k (2.1), for each basis function A and component c = 11, 12, 13, 22, 23, 33 of G, to sums[n (6 rows[A] + c) +
/// l], with n = assembly_block = 16, unless bit l of `skip` is set. With normals, T_ijk n_k replaces G. Target l has the coordinates target[l],
/// target[n + l] and target[2 n + l]. Differences x_k - x0_l are computed in double precision. A node that coincides with the target, up to rounding,
/// is skipped, as in stokeslet_sum(). `scratch`: 6 n n_nodes numbers.
void far_moments(const PanelNodes<float>& panel, const double* target, std::uint32_t skip, float* scratch, float* sums);
void far_moments(const PanelNodes<double>& panel, const double* target, std::uint32_t skip, double* scratch, double* sums);

/// Returns the sums for the two identities of the rule `desingularised` (see Layer), over the nodes (x, y, z) for a target x0 with the normal n0.
/// N = (nx, ny, nz) is the normal of a node times its quadrature weight, and r is the vector from the target to the node:
///   pressure_i = sum G_ij N_j;   shear_ij = sum G_ij (n0.N) + (G n0)_i N_j - (n0.r) T_ijk N_k, row by row.
struct IdentitySums {
  double pressure[3], shear[9];
};
IdentitySums identity_sums(int n, const double* x, const double* y, const double* z, const double* nx, const double* ny, const double* nz,
                           const double* x0, const double* n0);

}  // namespace tanktread::stokes
