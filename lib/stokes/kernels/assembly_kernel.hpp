#pragma once
// Far-field part of assembled matrix rows: sums of kernel times basis function over the far nodes of one panel, for sixteen targets at a time.

#include <cstdint>

namespace tanktread::stokes {

constexpr int assembly_block = 16;  ///< number of targets that are processed together in one pass
constexpr int assembly_tile = 4;    ///< basis functions are processed in groups of this size, to which their number is padded

/// One panel with its far nodes at the positions `x`, `y`, `z`. `weight`: quadrature weights times area element, for the single layer. If it is null,
/// `normal` has the unit normals times these weights, for the double layer. basis[n_nodes A + k]: value of basis function A = 0 .. functions - 1 at
/// node k. rows[A]: row of the argument `sums` of far_moments() to which basis function A adds.
template <class Real>
struct PanelNodes {
  int n_nodes = 0, functions = 0;
  const double *x = nullptr, *y = nullptr, *z = nullptr;
  const double* weight = nullptr;  ///< weights of the single layer
  const double* normal[3] = {};    ///< weighted normals of the double layer, used if `weight` is null
  const Real* basis = nullptr;
  const int* rows = nullptr;
};

/// Adds the sum of G_c(x_k, x0_l) N_A(x_k) w_k (2.1) over the nodes k to sums[n (6 rows[A] + c) + l], for each basis function A and target l, with n
/// = assembly_block = 16. c = 0 .. 5 numbers the entries 11, 12, 13, 22, 23, 33 of G. If bit l of `skip` is set, nothing is added for target l. If
/// `weight` is null, T_ijm n_m with the weighted normals n replaces G w_k. Target l has the coordinates target[l], target[n + l] and target[2 n + l].
/// Differences x_k - x0_l are computed in double precision. A node that coincides with the target, up to rounding, is skipped, as in stokeslet_sum().
/// `scratch`: 6 n n_nodes numbers.
void far_moments(const PanelNodes<float>& panel, const double* target, std::uint32_t skip, float* scratch, float* sums);
void far_moments(const PanelNodes<double>& panel, const double* target, std::uint32_t skip, double* scratch, double* sums);

}  // namespace tanktread::stokes
