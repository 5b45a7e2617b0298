#pragma once
// Far part of assembled rows: moments of the kernel with the basis functions of one panel, sixteen targets side by side.

#include <cstdint>

namespace tanktread::stokes {

constexpr int assembly_block = 16;  ///< targets that share one pass
constexpr int assembly_tile = 4;    ///< basis functions are padded to a multiple of this

/// One panel with its far nodes: positions, weights (area included) or normals times area, basis values basis[n_nodes A + k],
/// A = 0 .. functions - 1, and the row of `sums` that each function adds to.
template <class Real>
struct PanelNodes {
  int n_nodes = 0, functions = 0;
  const double *x = nullptr, *y = nullptr, *z = nullptr;
  const double* weight = nullptr;  ///< of the single layer
  const double* normal[3] = {};    ///< of the double layer, when there is no weight
  const Real* basis = nullptr;
  const int* rows = nullptr;
};

/// sums[block (6 rows[A] + c) + l] += sum_k G_c(x_k, x0_l) N_A(x_k) w_k for the targets l whose bit in `skip` is not set;
/// c = 11, 12, 13, 22, 23, 33 (2.1), or the same of T_ijk n_k where normals are given. Target l has the coordinates target[l],
/// target[block + l], target[2 block + l], block = 16. Differences are taken in double precision. `scratch`: 6 n_nodes blocks.
void far_moments(const PanelNodes<float>& panel, const double* target, std::uint32_t skip, float* scratch, float* sums);
void far_moments(const PanelNodes<double>& panel, const double* target, std::uint32_t skip, double* scratch, double* sums);
template <class Real>
void add_far_moments(const PanelNodes<Real>& panel, const double* target, std::uint32_t skip, Real* scratch, Real* sums) {
  far_moments(panel, target, skip, scratch, sums);
}

}  // namespace tanktread::stokes
