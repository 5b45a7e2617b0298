#pragma once
// Direct sums of the contributions of all nodes at one block of targets, or at one target, on plain arrays.

#include <array>
#include <span>
#include <vector>

#include "base/types.hpp"

namespace tanktread::stokes {

/// Points with up to six source strengths q each. A point force has three: the components of the force density times the quadrature weight.
struct Charges {
  int n = 0;
  const double *x = nullptr, *y = nullptr, *z = nullptr;
  std::array<const double*, 6> q{};

  Charges part(int first, int count) const {
    Charges c{count, x + first, y + first, z + first, q};
    for (const double*& component : c.q) component = component ? component + first : nullptr;
    return c;
  }
};

/// Returns all points with the positions `x` and the source strengths `q`, one array per component.
inline Charges charges(const std::vector<double> (&x)[3], std::span<const std::vector<double>> q) {
  Charges all{static_cast<int>(x[0].size()), x[0].data(), x[1].data(), x[2].data(), {}};
  for (std::size_t c = 0; c < q.size(); ++c) all.q[c] = q[c].data();
  return all;
}

/// Nodes of a regularised double layer (the velocity at the target is subtracted): positions x, velocities v, and normals n times the area of the
/// node.
struct Stresslets {
  int n = 0;
  const double *x = nullptr, *y = nullptr, *z = nullptr, *vx = nullptr, *vy = nullptr, *vz = nullptr;
  const double *nx = nullptr, *ny = nullptr, *nz = nullptr;

  Stresslets part(int first, int count) const {
    return {count, x + first, y + first, z + first, vx + first, vy + first, vz + first, nx + first, ny + first, nz + first};
  }
};

/// Returns all nodes with the positions x, the velocities v and the normals n, one array per component.
inline Stresslets stresslets(const std::vector<double> (&x)[3], const std::vector<double> (&v)[3], const std::vector<double> (&n)[3]) {
  return {static_cast<int>(x[0].size()), x[0].data(), x[1].data(), x[2].data(), v[0].data(), v[1].data(), v[2].data(), n[0].data(), n[1].data(),
          n[2].data()};
}

/// Number of targets that are processed together in one pass over the nodes.
constexpr int far_block = 16;

/// Returns the squared distance below which a node counts as coincident with the target (x0, y0, z0), because of the rounding of coordinates.
template <class Number>
Number coincident(const Number& x0, const Number& y0, const Number& z0) {
  return 0x1p-80 * (x0 * x0 + y0 * y0 + z0 * z0);
}

/// Computes u_l = sum_k G(x_k, x0_l) f_k (2.1) for l = 0 .. far_block - 1. Target l has the coordinates target[l], target[far_block + l],
/// target[2 far_block + l]; u has the same layout. Each sum runs over the nodes in their order. A node that coincides with the target, up to rounding
/// (2^-40 of the target's distance from the origin), is skipped.
void stokeslet_sum(const Charges& forces, const double* target, double* u);

/// Computes the stokeslet_sum() of a few point forces at one target x0[3]; result u[3]. If a better quadrature rule replaces these nodes, the caller
/// subtracts this sum from the far sum.
void node_sum(const Charges& forces, const double* x0, double* u);

/// Compute the double layer (2.2), u_l = sum over the nodes k of (v_k - v0_l)_j T_ijm(x_k, x0_l) n_m, for far_block targets or one target. In
/// far_sum(), target[far_block c + l] is coordinate c = 0, 1, 2 of target l, and for c = 3, 4, 5 component c - 3 of the velocity v0 there.
void far_sum(const Stresslets& nodes, const double* target, double* u);
void node_sum(const Stresslets& nodes, const double* x0, const double* v0, double* u);

/// Kernels for TreeSum: each computes a sum over sources with several components, at far_block targets. Targets have the layout of stokeslet_sum().
/// Component c of the result at target l is value[far_block c + l].
void stresslet_sum(const Charges& points, const double* target, double* value);
void normal_stress_sum(const Charges& points, const double* target, double* value);
using KernelSum = void (*)(const Charges& points, const double* target, double* value);

struct StokesletKernel {  ///< kernel for TreeSum: maps forces f to the velocities G f
  static constexpr int in = 3, out = 3;
  static constexpr auto* sum = stokeslet_sum;
};
/// Number of entries of a symmetric kernel that are stored.
constexpr int kernel_entries = 6;
/// Order of the entries of a symmetric kernel and of assembled rows: 11, 12, 13, 22, 23, 33.
constexpr int upper[kernel_entries][2] = {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}};
/// Order of the six components of a symmetric stress: 11, 22, 33, 12, 13, 23.
constexpr int stresses[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

struct StressletKernel {  ///< kernel for TreeSum: maps symmetric stresslet strengths (S_jk + S_kj)/2, ordered as in `stresses`, to T_ijk S_jk
  static constexpr int in = 6, out = 3;
  static constexpr auto* sum = stresslet_sum;
};
struct NormalStressKernel {  ///< kernel for TreeSum: maps normals n to T_ijk n_k, with the components ij ordered as in `stresses`
  static constexpr int in = 3, out = 6;
  static constexpr auto* sum = normal_stress_sum;
};

}  // namespace tanktread::stokes
