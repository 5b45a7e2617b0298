#pragma once
// Polynomial interpolation in a box: transfers source strengths from points to Chebyshev nodes, and field values from Chebyshev nodes to points.

#include <array>

#include "stokes/kernels/far_kernel.hpp"
#include "base/pack.hpp"

namespace tanktread::stokes {

/// Maximum number of Chebyshev nodes per direction.
constexpr int most_chebyshev = 16;

/// Returns whether spread() and interpolate() are compiled for n components: the components of a vector or of a symmetric tensor.
constexpr bool has_cluster_kernel(int n) { return n == 3 || n == 6; }

/// A box with its centre, orthonormal axes (rows of `axes`), half lengths along the axes, and numbers n_d = order[d] of Chebyshev nodes along axis d.
/// The nodes along an axis are at cos(pi (2a + 1)/(2 n_d)) times the half length. Node (a, b, c) has the index a + n_0 (b + n_1 c).
struct ChebyshevBox {
  double centre[3] = {}, axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, half[3] = {};
  std::array<int, 3> order{1, 1, 1};

  int n_nodes() const { return order[0] * order[1] * order[2]; }
};

/// Computes the positions (x, y, z) of the Chebyshev nodes of the box.
void chebyshev_nodes(const ChebyshevBox& box, double* x, double* y, double* z);

/// Replaces points in the box by Chebyshev nodes with the same far field: adds sum_k L_abc(x_k) q_ik to the source strength node_q[i] of node
/// (a, b, c), for the components i < n. q_ik is component i of point k, and L_abc the Lagrange polynomial of the node. n must be 3 or 6. `scratch`: n
/// n_nodes packs.
void spread(int n, const ChebyshevBox& box, const Charges& points, Pack* scratch, const std::array<double*, 6>& node_q);

/// Interpolates a field with n components from the nodes to points x of the box: u += sum_abc L_abc(x) u_abc, where u_abc is the value at node
/// (a, b, c). n must be 3 or 6. All arrays are in blocks of far_block points: component c at point l of block k is array[m far_block k + far_block c
/// + l], with m = n components for the field and m = 3 for positions.
void interpolate(int n, const ChebyshevBox& box, const double* node_u, int blocks, const double* target, double* u);

}  // namespace tanktread::stokes
