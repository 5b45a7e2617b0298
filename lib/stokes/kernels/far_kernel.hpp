#pragma once
// The bare sums: every target against every node, on plain arrays.

#include <array>
#include <span>

#include "base/types.hpp"

namespace tanktread::stokes {

/// Point forces: positions and strengths (weight times density), n of each.
struct PointForces {
  int n = 0;
  const double *x = nullptr, *y = nullptr, *z = nullptr, *fx = nullptr, *fy = nullptr, *fz = nullptr;

  PointForces part(int first, int count) const { return {count, x + first, y + first, z + first, fx + first, fy + first, fz + first}; }
};

/// Regularised stresslets: positions, velocities, and normals times the area of the node.
struct Stresslets {
  int n = 0;
  const double *x = nullptr, *y = nullptr, *z = nullptr, *vx = nullptr, *vy = nullptr, *vz = nullptr;
  const double *nx = nullptr, *ny = nullptr, *nz = nullptr;

  Stresslets part(int first, int count) const {
    return {count, x + first, y + first, z + first, vx + first, vy + first, vz + first, nx + first, ny + first, nz + first};
  }
};

/// Of the terms of a far sum; what they are summed up to is double.
enum class Precision { single, full };

/// Targets that share one pass over the nodes.
constexpr int far_block = 16;

/// u_l = sum_k G(x_k, x0_l) f_k (2.1) for l = 0 .. far_block - 1. Target l has the coordinates target[l], target[far_block + l],
/// target[2 far_block + l]; u alike. Each target's sum runs over the nodes in their order. A node at the target,
/// to rounding (2^-40 of the target's distance from the origin), counts as nothing.
void far_sum(const PointForces& forces, const double* target, double* u);

/// u[3 k + c] of it for any number of targets.
void far_sums(const PointForces& forces, std::span<const Vec3> targets, double* u, Precision precision = Precision::full);

/// The same for one target x0[3], u[3]: what a pair with a better rule takes back.
void node_sum(const PointForces& forces, const double* x0, double* u);

/// u_l = sum_k (v_k - v0_l)_j T_ijk(x_k, x0_l) n_k (2.2). target[block c + l]: c = 0, 1, 2 the place, 3, 4, 5 the velocity v0 there.
void far_sum(const Stresslets& nodes, const double* target, double* u);
void far_sums(const Stresslets& nodes, std::span<const Vec3> targets, std::span<const Vec3> v0, double* u, Precision precision = Precision::full);
void node_sum(const Stresslets& nodes, const double* x0, const double* v0, double* u);

/// The same sums in single precision: differences of places are good to 1e-7 of themselves, however close the places are, for what single precision
/// leaves of a place counts as well; terms of `single_run` nodes are added up before they go to the sum in double. Off by 3e-8 of the sum of
/// the terms' magnitudes (root mean square; at most 3e-7). What one target gets does not depend on the others.
constexpr int single_run = 64;
void far_sum_in_single(const PointForces& forces, const double* target, double* u);
void far_sum_in_single(const Stresslets& nodes, const double* target, double* u);

/// Points that carry up to six numbers each.
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

/// Kernels that TreeSum interpolates: numbers a point carries, numbers a target gets, and the sum for far_block targets, which are given as
/// to far_sum(); value[far_block c + l].
void stokeslet_sum(const Charges& points, const double* target, double* value);
void stresslet_sum(const Charges& points, const double* target, double* value);
void normal_stress_sum(const Charges& points, const double* target, double* value);
void stokeslet_sum_in_single(const Charges& points, const double* target, double* value);
void stresslet_sum_in_single(const Charges& points, const double* target, double* value);
using KernelSum = void (*)(const Charges& points, const double* target, double* value);

/// u[3 k + c] of one of these with three numbers a target, for any number of targets.
void kernel_sums(KernelSum kernel, const Charges& points, std::span<const Vec3> targets, double* u);

struct StokesletKernel {  ///< forces -> G f
  static constexpr int in = 3, out = 3;
  static constexpr auto *sum = stokeslet_sum, *single = stokeslet_sum_in_single;
};
/// The order in which the six numbers of a symmetric stress are carried: 11, 22, 33, 12, 13, 23.
constexpr int stresses[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};

struct StressletKernel {  ///< S_jk + S_kj over 2 in that order -> T_ijk S_jk
  static constexpr int in = 6, out = 3;
  static constexpr auto *sum = stresslet_sum, *single = stresslet_sum_in_single;
};
struct NormalStressKernel {  ///< n_k -> T_ijk n_k, ij in that order
  static constexpr int in = 3, out = 6;
  static constexpr auto *sum = normal_stress_sum, *single = normal_stress_sum;  // once a shape
};

}  // namespace tanktread::stokes
