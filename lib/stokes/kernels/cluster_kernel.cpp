#include "stokes/kernels/cluster_kernel.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "base/kernel.hpp"

namespace tanktread::stokes {
namespace INSTRUCTIONS {
namespace {

/// Chebyshev nodes in one direction, and their barycentric weights 1 / prod_{b != a} (x_a - x_b).
struct Nodes {
  double x[most_chebyshev], scale[most_chebyshev];
};

std::array<Nodes, most_chebyshev + 1> table() {
  std::array<Nodes, most_chebyshev + 1> all{};
  for (int n = 1; n <= most_chebyshev; ++n) {
    Nodes& nodes = all[n];
    for (int a = 0; a < n; ++a) nodes.x[a] = std::cos(std::numbers::pi * (2 * a + 1) / (2 * n));
    for (int a = 0; a < n; ++a) {
      double product = 1;
      for (int b = 0; b < n; ++b) product *= a == b ? 1 : nodes.x[a] - nodes.x[b];
      nodes.scale[a] = 1 / product;
    }
  }
  return all;
}

const Nodes& nodes(int n) {
  static const auto all = table();
  return all[n];
}

/// Evaluates the Lagrange polynomials of the n Chebyshev nodes at x, without division.
void lagrange(int n, const Register& x, Register* value) {
  const Nodes& at = nodes(n);
  Register product = Register{} + 1;
  for (int a = 0; a < n; ++a) {
    value[a] = product * at.scale[a];
    product *= x - at.x[a];
  }
  product = Register{} + 1;
  for (int a = n - 1; a >= 0; --a) {
    value[a] *= product;
    product *= x - at.x[a];
  }
}

/// Lagrange polynomials along the three axes of a box, evaluated at as many points as fit into a register.
struct Basis {
  Register along[3][most_chebyshev];

  void place(const ChebyshevBox& box, const Register& x, const Register& y, const Register& z) {
    const Register rx = x - box.centre[0], ry = y - box.centre[1], rz = z - box.centre[2];
    for (int d = 0; d < 3; ++d) {
      const double scale = box.half[d] > 0 ? 1 / box.half[d] : 0;
      lagrange(box.order[d], (rx * box.axes[d][0] + ry * box.axes[d][1] + rz * box.axes[d][2]) * scale, along[d]);
    }
  }
};

Register load_some(const double* a, int n) {
  Register p{};
  std::memcpy(&p, a, sizeof(double) * std::min(n, lanes));
  return p;
}

template <int N>
void spread_components(const ChebyshevBox& box, const Charges& points, Register* scratch, const std::array<double*, 6>& node_q) {
  const auto [n0, n1, n2] = box.order;
  std::fill_n(scratch, N * box.n_nodes(), Register{});
  Basis basis;
  for (int k = 0; k < points.n; k += lanes) {
    const int n = points.n - k;  // number of points left; lanes beyond the last point get zero strength
    basis.place(box, load_some(points.x + k, n), load_some(points.y + k, n), load_some(points.z + k, n));
    Register q[N];
    for (int d = 0; d < N; ++d) q[d] = load_some(points.q[d] + k, n);
    Register* sum = scratch;
    for (int c = 0; c < n2; ++c)
      for (int b = 0; b < n1; ++b) {
        const Register both = basis.along[1][b] * basis.along[2][c];
        Register part[N];
        for (int d = 0; d < N; ++d) part[d] = both * q[d];
        for (int a = 0; a < n0; ++a, sum += N)
          for (int d = 0; d < N; ++d) sum[d] += basis.along[0][a] * part[d];
      }
  }
  for (int i = 0; i < box.n_nodes(); ++i)
    for (int d = 0; d < N; ++d) node_q[d][i] += tanktread::sum(scratch[N * i + d]);
}

template <int N>
void interpolate_components(const ChebyshevBox& box, const double* node_u, int blocks, const double* target, double* u) {
  const auto [n0, n1, n2] = box.order;
  Basis basis;
  for (int k = 0; k < blocks; ++k, target += 3 * far_block, u += N * far_block)
    for (int l = 0; l < far_block; l += lanes) {
      basis.place(box, load(target + l), load(target + far_block + l), load(target + 2 * far_block + l));
      Register sum[N]{};
      int i = 0;
      for (int c = 0; c < n2; ++c)
        for (int b = 0; b < n1; ++b) {
          Register row[N]{};
          for (int a = 0; a < n0; ++a, ++i) {
            const double* node = node_u + N * far_block * (i / far_block) + i % far_block;
            for (int d = 0; d < N; ++d) row[d] += basis.along[0][a] * node[far_block * d];
          }
          const Register both = basis.along[1][b] * basis.along[2][c];
          for (int d = 0; d < N; ++d) sum[d] += both * row[d];
        }
      for (int d = 0; d < N; ++d) {
        const Register value = load(u + far_block * d + l) + sum[d];
        store(value, u + far_block * d + l);
      }
    }
}

}  // namespace

void chebyshev_nodes(const ChebyshevBox& box, double* x, double* y, double* z) {
  for (int c = 0; c < box.order[2]; ++c)
    for (int b = 0; b < box.order[1]; ++b)
      for (int a = 0; a < box.order[0]; ++a) {
        const double r[3] = {box.half[0] * nodes(box.order[0]).x[a], box.half[1] * nodes(box.order[1]).x[b],
                             box.half[2] * nodes(box.order[2]).x[c]};
        double at[3];
        for (int i = 0; i < 3; ++i) at[i] = box.centre[i] + r[0] * box.axes[0][i] + r[1] * box.axes[1][i] + r[2] * box.axes[2][i];
        *x++ = at[0], *y++ = at[1], *z++ = at[2];
      }
}

void spread(int n, const ChebyshevBox& box, const Charges& points, Pack* scratch, const std::array<double*, 6>& node_q) {
  Register* const sums = registers(scratch);
  n == 3 ? spread_components<3>(box, points, sums, node_q) : spread_components<6>(box, points, sums, node_q);
}

void interpolate(int n, const ChebyshevBox& box, const double* node_u, int blocks, const double* target, double* u) {
  n == 3 ? interpolate_components<3>(box, node_u, blocks, target, u) : interpolate_components<6>(box, node_u, blocks, target, u);
}

}  // namespace INSTRUCTIONS

KERNEL(void, chebyshev_nodes, (const ChebyshevBox& box, double* x, double* y, double* z), (box, x, y, z))
KERNEL(void, spread, (int n, const ChebyshevBox& box, const Charges& points, Pack* scratch, const std::array<double*, 6>& node_q),
       (n, box, points, scratch, node_q))
KERNEL(void, interpolate, (int n, const ChebyshevBox& box, const double* node_u, int blocks, const double* target, double* u),
       (n, box, node_u, blocks, target, u))

}  // namespace tanktread::stokes
