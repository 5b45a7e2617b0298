#pragma once
// Polynomial interpolation in a box: from points to the Chebyshev nodes that stand for them, and back.

#include <array>

#include "stokes/kernels/far_kernel.hpp"
#include "base/pack.hpp"

namespace tanktread::stokes {

/// Most Chebyshev nodes a direction.
constexpr int most_chebyshev = 16;

/// A box with axes of its own (rows, orthonormal), and how many Chebyshev nodes cos(pi (2a + 1)/(2n)) it has along each of them. Node
/// (a, b, c) is number a + n_0 (b + n_1 c).
struct ChebyshevBox {
  double centre[3] = {}, axes[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, half[3] = {};
  std::array<int, 3> order{1, 1, 1};

  int n_nodes() const { return order[0] * order[1] * order[2]; }
};

/// Places of the nodes.
void chebyshev_nodes(const ChebyshevBox& box, double* x, double* y, double* z);

/// Numbers at the nodes that act from afar like those at points of the box: node_q[c] += sum_k L_abc(x_k) q_k, L_abc the Lagrange
/// polynomials of the nodes, for the first n components. `scratch`: n n_nodes packs.
void spread(int n, const ChebyshevBox& box, const Charges& points, Pack* scratch, const std::array<double*, 6>& node_q);

/// n fields known at the nodes, in other points of the box: u += sum_abc L_abc(x) u_abc. All in blocks of far_block, as kernels want targets
/// and give values: block[n far_block k + far_block c + l].
void interpolate(int n, const ChebyshevBox& box, const double* node_u, int blocks, const double* target, double* u);

}  // namespace tanktread::stokes
