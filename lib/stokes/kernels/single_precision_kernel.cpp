#include <algorithm>
#include <cmath>

#include "base/kernel.hpp"
#include "stokes/kernels/far_kernel.hpp"

namespace tanktread::stokes {
namespace INSTRUCTIONS {
namespace {

constexpr int wide = RegisterOf<float>::lanes;

/// Coordinates of points relative to an origin, scaled by a power of two and split into a single-precision part (`place`) and the remainder
/// (`remainder`).
template <int size>
struct Split {
  alignas(register_bytes) float place[3][size], remainder[3][size];

  void take(int c, int n, const double* x, double origin, double scale) {
    for (int k = 0; k < n; ++k) {
      const double from = scale * (x[k] - origin);
      place[c][k] = static_cast<float>(from);
      remainder[c][k] = static_cast<float>(from - static_cast<double>(place[c][k]));
    }
  }
};

/// Coordinates of consecutive nodes and of a block of targets, relative to the first of these nodes. The coordinates are scaled by the distance of
/// the farthest target, so that powers of distances stay within the range of single precision in any units.
struct Sight {
  Split<single_run> nodes;
  Split<far_block> targets;
  alignas(register_bytes) float least[far_block];  // squared distance below which a node counts as coincident with a target
  double scale;

  Sight(int n, const double* const (&x)[3], const double* target) {
    double farthest = 0;
    for (int c = 0; c < 3; ++c)
      for (int l = 0; l < far_block; ++l) farthest = std::max(farthest, std::abs(target[far_block * c + l] - x[c][0]));
    scale = farthest > 0 ? std::ldexp(1., -std::ilogb(farthest)) : 1;
    for (int c = 0; c < 3; ++c) {
      nodes.take(c, n, x[c], x[c][0], scale);
      targets.take(c, far_block, target + far_block * c, x[c][0], scale);
    }
    for (int l = 0; l < far_block; ++l) {
      double square = 0;
      for (int c = 0; c < 3; ++c) square += scale * target[far_block * c + l] * (scale * target[far_block * c + l]);
      least[l] = static_cast<float>(0x1p-80 * square);
    }
  }

  /// Computes the vectors r to node k from the targets of one register, which starts with target `first`.
  void difference(int first, int k, FloatRegister (&r)[3]) const {
    for (int c = 0; c < 3; ++c) {
      const FloatRegister place = as_it_stands(nodes.place[c][k] - load(&targets.place[c][first]));
      r[c] = place + (nodes.remainder[c][k] - load(&targets.remainder[c][first]));
    }
  }
};

/// Computes the differences of n values to `origin` and rounds them to single precision.
template <int size>
void narrow(int n, const double* from, double origin, float (&to)[size]) {
  for (int k = 0; k < n; ++k) to[k] = static_cast<float>(from[k] - origin);
}

/// Adds the sums over n nodes to u, times `factor`, which undoes the scaling of the coordinates. term(first, k, r, inverse, sum) adds the term of
/// node k to `sum`, for the targets of the register that starts with target `first`; `inverse` is 1/|r|.
template <class Term>
inline void add_terms(const Sight& sight, int n, double factor, double* u, const Term& term) {
  for (int first = 0; first < far_block; first += wide) {
    FloatRegister r[3], sum[3] = {};
    const FloatRegister least = load(&sight.least[first]);
    for (int k = 0; k < n; ++k) {
      sight.difference(first, k, r);
      term(first, k, r, inverse_root(r[0] * r[0] + r[1] * r[1] + r[2] * r[2], least), sum);
    }
    for (int c = 0; c < 3; ++c)
      for (int l = 0; l < wide; ++l) u[far_block * c + first + l] += factor * static_cast<double>(sum[c][l]);
  }
}

using Three = FloatRegister[3];

void add_differences(const Stresslets& nodes, const double* target, double* u) {
  const Sight sight(nodes.n, {nodes.x, nodes.y, nodes.z}, target);
  float v[3][single_run], n[3][single_run], v0[3][far_block];
  const double *const velocity[3] = {nodes.vx, nodes.vy, nodes.vz}, *const normal[3] = {nodes.nx, nodes.ny, nodes.nz};
  for (int c = 0; c < 3; ++c) {  // velocities relative to the velocity of the first node: these differences are small for close nodes, so that their
                                 // rounding is harmless
    narrow(nodes.n, velocity[c], velocity[c][0], v[c]);
    narrow(far_block, target + far_block * (3 + c), velocity[c][0], v0[c]);
    narrow(nodes.n, normal[c], 0, n[c]);
  }
  add_terms(sight, nodes.n, sight.scale * sight.scale, u, [&](int first, int k, const Three& r, const FloatRegister& inverse, Three& sum) {
    FloatRegister along{};
    for (int c = 0; c < 3; ++c) along += r[c] * (v[c][k] - load(&v0[c][first]));
    const FloatRegister outward = r[0] * n[0][k] + r[1] * n[1][k] + r[2] * n[2][k], square = inverse * inverse;
    const FloatRegister strength = -6 * along * outward * (square * square * inverse);
    for (int c = 0; c < 3; ++c) sum[c] += strength * r[c];
  });
}

void add_forces(const Charges& forces, const double* target, double* u) {
  const Sight sight(forces.n, {forces.x, forces.y, forces.z}, target);
  float f[3][single_run];
  for (std::size_t c = 0; c < 3; ++c) narrow(forces.n, forces.q[c], 0, f[c]);
  add_terms(sight, forces.n, sight.scale, u, [&](int, int k, const Three& r, const FloatRegister& inverse, Three& sum) {
    const FloatRegister along = (r[0] * f[0][k] + r[1] * f[1][k] + r[2] * f[2][k]) * (inverse * inverse);
    for (int c = 0; c < 3; ++c) sum[c] += inverse * (f[c][k] + r[c] * along);
  });
}

void add_stresslets(const Charges& points, const double* target, double* u) {
  const Sight sight(points.n, {points.x, points.y, points.z}, target);
  float q[6][single_run];
  for (int c = 0; c < 6; ++c) narrow(points.n, points.q[static_cast<unsigned>(c)], 0, q[c]);
  add_terms(sight, points.n, sight.scale * sight.scale, u, [&](int, int k, const Three& r, const FloatRegister& inverse, Three& sum) {
    const FloatRegister form = r[0] * (q[0][k] * r[0]) + r[1] * (q[1][k] * r[1]) + r[2] * (q[2][k] * r[2]) +
                               2 * (r[0] * (q[3][k] * r[1] + q[4][k] * r[2]) + r[1] * (q[5][k] * r[2]));
    const FloatRegister square = inverse * inverse, strength = -6 * form * (square * square * inverse);
    for (int c = 0; c < 3; ++c) sum[c] += strength * r[c];
  });
}

/// Computes the sum over the nodes in runs, each of at most `single_run` nodes. `add` adds the sum over one run to u.
template <class Nodes>
void sum_of_runs(void (*add)(const Nodes&, const double*, double*), const Nodes& nodes, const double* target, double* u) {
  std::fill_n(u, 3 * far_block, 0.);
  for (int first = 0; first < nodes.n; first += single_run) add(nodes.part(first, std::min(single_run, nodes.n - first)), target, u);
}

}  // namespace

void far_sum_in_single(const Stresslets& nodes, const double* target, double* u) { sum_of_runs(add_differences, nodes, target, u); }

void stokeslet_sum_in_single(const Charges& forces, const double* target, double* u) { sum_of_runs(add_forces, forces, target, u); }

void stresslet_sum_in_single(const Charges& points, const double* target, double* value) { sum_of_runs(add_stresslets, points, target, value); }

}  // namespace INSTRUCTIONS

KERNEL(void, far_sum_in_single, (const Stresslets& nodes, const double* target, double* u), (nodes, target, u))
KERNEL(void, stokeslet_sum_in_single, (const Charges& forces, const double* target, double* u), (forces, target, u))
KERNEL(void, stresslet_sum_in_single, (const Charges& points, const double* target, double* value), (points, target, value))

}  // namespace tanktread::stokes
