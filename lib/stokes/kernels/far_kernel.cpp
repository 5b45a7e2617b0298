#include "stokes/kernels/far_kernel.hpp"

#include <cmath>

#include "base/kernel.hpp"

namespace tanktread::stokes {
namespace INSTRUCTIONS {
namespace {

constexpr int packs = far_block / lanes;

/// Number of packs of targets that are summed at the same time.
constexpr int tile = packs < 4 ? packs : 4;

/// Computes stokeslet_sum() for `tile` packs of targets; a pack fills one register.
void tile_sum(const Charges& forces, const double* target, double* u) {
  Register x0[tile], y0[tile], z0[tile], least[tile], ux[tile] = {}, uy[tile] = {}, uz[tile] = {};
  for (int p = 0; p < tile; ++p) {
    x0[p] = load(target + lanes * p);
    y0[p] = load(target + far_block + lanes * p);
    z0[p] = load(target + 2 * far_block + lanes * p);
    least[p] = coincident(x0[p], y0[p], z0[p]);
  }
  for (int k = 0; k < forces.n; ++k) {
    const double x = forces.x[k], y = forces.y[k], z = forces.z[k], fx = forces.q[0][k], fy = forces.q[1][k], fz = forces.q[2][k];
#pragma GCC unroll 8
    for (int p = 0; p < tile; ++p) {
      const Register rx = x - x0[p], ry = y - y0[p], rz = z - z0[p];
      const Register inverse = inverse_root(rx * rx + ry * ry + rz * rz, least[p]);
      const Register along = (rx * fx + ry * fy + rz * fz) * (inverse * inverse);
      ux[p] += inverse * (fx + rx * along);
      uy[p] += inverse * (fy + ry * along);
      uz[p] += inverse * (fz + rz * along);
    }
  }
  for (int p = 0; p < tile; ++p) {
    store(ux[p], u + lanes * p);
    store(uy[p], u + far_block + lanes * p);
    store(uz[p], u + 2 * far_block + lanes * p);
  }
}

/// Computes `out` sums over all nodes for each target, one pack of targets at a time. A target has `in` input values, of which the first three are
/// its position. term(k, r, target, 1/|r|, sums) adds the terms of node k to `sums`; r is the vector from the target to the node.
template <int in, int out, class Nodes, class Term>
void sums_of_packs(const Nodes& nodes, const double* target, double* value, const Term& term) {
  for (int p = 0; p < packs; ++p) {
    Register t[in], sums[out] = {};
    for (int c = 0; c < in; ++c) t[c] = load(target + far_block * c + lanes * p);
    const Register least = coincident(t[0], t[1], t[2]);
    for (int k = 0; k < nodes.n; ++k) {
      const Register r[3] = {nodes.x[k] - t[0], nodes.y[k] - t[1], nodes.z[k] - t[2]};
      term(k, r, t, inverse_root(r[0] * r[0] + r[1] * r[1] + r[2] * r[2], least), sums);
    }
    for (int c = 0; c < out; ++c) store(sums[c], value + far_block * c + lanes * p);
  }
}

}  // namespace

void stokeslet_sum(const Charges& forces, const double* target, double* u) {
  for (int first = 0; first < far_block; first += tile * lanes) tile_sum(forces, target + first, u + first);
}

void node_sum(const Charges& forces, const double* x0, double* u) {
  const auto& q = forces.q;
  const double least = coincident(x0[0], x0[1], x0[2]);
  double ux = 0, uy = 0, uz = 0;
  for (int k = 0; k < forces.n; ++k) {
    const double rx = forces.x[k] - x0[0], ry = forces.y[k] - x0[1], rz = forces.z[k] - x0[2];
    const double square = rx * rx + ry * ry + rz * rz, inverse = square > least ? 1 / std::sqrt(square) : 0;
    const double along = (rx * q[0][k] + ry * q[1][k] + rz * q[2][k]) * (inverse * inverse);
    ux += inverse * (q[0][k] + rx * along);
    uy += inverse * (q[1][k] + ry * along);
    uz += inverse * (q[2][k] + rz * along);
  }
  u[0] = ux, u[1] = uy, u[2] = uz;
}

void far_sum(const Stresslets& nodes, const double* target, double* u) {
  sums_of_packs<6, 3>(nodes, target, u, [&](int k, const Register (&r)[3], const Register (&t)[6], const Register& inverse, Register (&sum)[3]) {
    const Register square = inverse * inverse;
    const Register velocity = r[0] * (nodes.vx[k] - t[3]) + r[1] * (nodes.vy[k] - t[4]) + r[2] * (nodes.vz[k] - t[5]);
    const Register normal = r[0] * nodes.nx[k] + r[1] * nodes.ny[k] + r[2] * nodes.nz[k];
    const Register strength = -6 * velocity * normal * (square * square * inverse);
    for (int c = 0; c < 3; ++c) sum[c] += strength * r[c];
  });
}

void node_sum(const Stresslets& nodes, const double* x0, const double* v0, double* u) {
  const double least = coincident(x0[0], x0[1], x0[2]);
  double ux = 0, uy = 0, uz = 0;
  for (int k = 0; k < nodes.n; ++k) {
    const double rx = nodes.x[k] - x0[0], ry = nodes.y[k] - x0[1], rz = nodes.z[k] - x0[2];
    const double square = rx * rx + ry * ry + rz * rz, inverse = square > least ? 1 / std::sqrt(square) : 0;
    const double velocity = rx * (nodes.vx[k] - v0[0]) + ry * (nodes.vy[k] - v0[1]) + rz * (nodes.vz[k] - v0[2]);
    const double normal = rx * nodes.nx[k] + ry * nodes.ny[k] + rz * nodes.nz[k];
    const double strength = -6 * velocity * normal * inverse * inverse * inverse * inverse * inverse;
    ux += strength * rx;
    uy += strength * ry;
    uz += strength * rz;
  }
  u[0] = ux, u[1] = uy, u[2] = uz;
}

void stresslet_sum(const Charges& points, const double* target, double* value) {
  const auto& q = points.q;
  sums_of_packs<3, 3>(points, target, value, [&](int k, const Register (&r)[3], const auto&, const Register& inverse, Register (&sum)[3]) {
    const Register square = inverse * inverse;
    const Register form = r[0] * (q[0][k] * r[0]) + r[1] * (q[1][k] * r[1]) + r[2] * (q[2][k] * r[2]) +
                          2 * (r[0] * (q[3][k] * r[1] + q[4][k] * r[2]) + r[1] * (q[5][k] * r[2]));
    const Register strength = -6 * form * (square * square * inverse);
    for (int c = 0; c < 3; ++c) sum[c] += strength * r[c];
  });
}

void normal_stress_sum(const Charges& points, const double* target, double* value) {
  const auto& n = points.q;
  sums_of_packs<3, 6>(points, target, value, [&](int k, const Register (&r)[3], const auto&, const Register& inverse, Register (&sum)[6]) {
    const Register square = inverse * inverse;
    const Register strength = -6 * (r[0] * n[0][k] + r[1] * n[1][k] + r[2] * n[2][k]) * (square * square * inverse);
    for (int c = 0; c < 6; ++c) sum[c] += strength * r[stresses[c][0]] * r[stresses[c][1]];
  });
}

}  // namespace INSTRUCTIONS

KERNEL(void, stokeslet_sum, (const Charges& forces, const double* target, double* u), (forces, target, u))
KERNEL(void, node_sum, (const Charges& forces, const double* x0, double* u), (forces, x0, u))
KERNEL(void, far_sum, (const Stresslets& nodes, const double* target, double* u), (nodes, target, u))
KERNEL(void, node_sum, (const Stresslets& nodes, const double* x0, const double* v0, double* u), (nodes, x0, v0, u))
KERNEL(void, stresslet_sum, (const Charges& points, const double* target, double* value), (points, target, value))
KERNEL(void, normal_stress_sum, (const Charges& points, const double* target, double* value), (points, target, value))

}  // namespace tanktread::stokes
