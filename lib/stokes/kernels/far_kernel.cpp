#include "stokes/kernels/far_kernel.hpp"

#include <cmath>

#include "base/kernel.hpp"

namespace tanktread::stokes {
namespace INSTRUCTIONS {
namespace {

constexpr int packs = far_block / lanes;

/// Packs of targets that are summed for side by side.
constexpr int tile = packs < 4 ? packs : 4;

/// The square of the distance at which a node coincides with the target x0, but for the rounding of their coordinates.
template <class Number>
Number coincident(const Number& x0, const Number& y0, const Number& z0) {
  return 0x1p-80 * (x0 * x0 + y0 * y0 + z0 * z0);
}

/// The targets of one tile.
void tile_sum(const PointForces& forces, const double* target, double* u) {
  Register x0[tile], y0[tile], z0[tile], least[tile], ux[tile] = {}, uy[tile] = {}, uz[tile] = {};
  for (int p = 0; p < tile; ++p) {
    x0[p] = load(target + lanes * p);
    y0[p] = load(target + far_block + lanes * p);
    z0[p] = load(target + 2 * far_block + lanes * p);
    least[p] = coincident(x0[p], y0[p], z0[p]);
  }
  for (int k = 0; k < forces.n; ++k) {
    const double x = forces.x[k], y = forces.y[k], z = forces.z[k], fx = forces.fx[k], fy = forces.fy[k], fz = forces.fz[k];
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

}  // namespace

void far_sum(const PointForces& forces, const double* target, double* u) {
  for (int first = 0; first < far_block; first += tile * lanes) tile_sum(forces, target + first, u + first);
}

void node_sum(const PointForces& forces, const double* x0, double* u) {
  const double least = coincident(x0[0], x0[1], x0[2]);
  double ux = 0, uy = 0, uz = 0;
  for (int k = 0; k < forces.n; ++k) {
    const double rx = forces.x[k] - x0[0], ry = forces.y[k] - x0[1], rz = forces.z[k] - x0[2];
    const double square = rx * rx + ry * ry + rz * rz, inverse = square > least ? 1 / std::sqrt(square) : 0;
    const double along = (rx * forces.fx[k] + ry * forces.fy[k] + rz * forces.fz[k]) * (inverse * inverse);
    ux += inverse * (forces.fx[k] + rx * along);
    uy += inverse * (forces.fy[k] + ry * along);
    uz += inverse * (forces.fz[k] + rz * along);
  }
  u[0] = ux, u[1] = uy, u[2] = uz;
}

void far_sum(const Stresslets& nodes, const double* target, double* u) {
  for (int p = 0; p < packs; ++p) {
    Register t[6], ux{}, uy{}, uz{};
    for (int c = 0; c < 6; ++c) t[c] = load(target + far_block * c + lanes * p);
    const Register least = coincident(t[0], t[1], t[2]);
    for (int k = 0; k < nodes.n; ++k) {
      const Register rx = nodes.x[k] - t[0], ry = nodes.y[k] - t[1], rz = nodes.z[k] - t[2];
      const Register inverse = inverse_root(rx * rx + ry * ry + rz * rz, least), square = inverse * inverse;
      const Register velocity = rx * (nodes.vx[k] - t[3]) + ry * (nodes.vy[k] - t[4]) + rz * (nodes.vz[k] - t[5]);
      const Register normal = rx * nodes.nx[k] + ry * nodes.ny[k] + rz * nodes.nz[k];
      const Register strength = -6 * velocity * normal * (square * square * inverse);
      ux += strength * rx;
      uy += strength * ry;
      uz += strength * rz;
    }
    store(ux, u + lanes * p);
    store(uy, u + far_block + lanes * p);
    store(uz, u + 2 * far_block + lanes * p);
  }
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

void stokeslet_sum(const Charges& p, const double* target, double* value) {
  INSTRUCTIONS::far_sum(PointForces{p.n, p.x, p.y, p.z, p.q[0], p.q[1], p.q[2]}, target, value);
}

void stresslet_sum(const Charges& points, const double* target, double* value) {
  const auto& q = points.q;
  for (int p = 0; p < packs; ++p) {
    Register t[3], u[3] = {};
    for (int c = 0; c < 3; ++c) t[c] = load(target + far_block * c + lanes * p);
    const Register least = coincident(t[0], t[1], t[2]);
    for (int k = 0; k < points.n; ++k) {
      const Register rx = points.x[k] - t[0], ry = points.y[k] - t[1], rz = points.z[k] - t[2];
      const Register inverse = inverse_root(rx * rx + ry * ry + rz * rz, least), square = inverse * inverse;
      const Register form =
          rx * (q[0][k] * rx) + ry * (q[1][k] * ry) + rz * (q[2][k] * rz) + 2 * (rx * (q[3][k] * ry + q[4][k] * rz) + ry * (q[5][k] * rz));
      const Register strength = -6 * form * (square * square * inverse);
      u[0] += strength * rx;
      u[1] += strength * ry;
      u[2] += strength * rz;
    }
    for (int c = 0; c < 3; ++c) store(u[c], value + far_block * c + lanes * p);
  }
}

void normal_stress_sum(const Charges& points, const double* target, double* value) {
  const auto& n = points.q;
  for (int p = 0; p < packs; ++p) {
    Register t[3], u[6] = {};
    for (int c = 0; c < 3; ++c) t[c] = load(target + far_block * c + lanes * p);
    const Register least = coincident(t[0], t[1], t[2]);
    for (int k = 0; k < points.n; ++k) {
      const Register rx = points.x[k] - t[0], ry = points.y[k] - t[1], rz = points.z[k] - t[2];
      const Register inverse = inverse_root(rx * rx + ry * ry + rz * rz, least), square = inverse * inverse;
      const Register strength = -6 * (rx * n[0][k] + ry * n[1][k] + rz * n[2][k]) * (square * square * inverse);
      const Register sx = strength * rx, sy = strength * ry;
      u[0] += sx * rx;
      u[1] += sy * ry;
      u[2] += strength * rz * rz;
      u[3] += sx * ry;
      u[4] += sx * rz;
      u[5] += sy * rz;
    }
    for (int c = 0; c < 6; ++c) store(u[c], value + far_block * c + lanes * p);
  }
}

}  // namespace INSTRUCTIONS

KERNEL(void, far_sum, (const PointForces& forces, const double* target, double* u), (forces, target, u))
KERNEL(void, node_sum, (const PointForces& forces, const double* x0, double* u), (forces, x0, u))
KERNEL(void, far_sum, (const Stresslets& nodes, const double* target, double* u), (nodes, target, u))
KERNEL(void, node_sum, (const Stresslets& nodes, const double* x0, const double* v0, double* u), (nodes, x0, v0, u))
KERNEL(void, stokeslet_sum, (const Charges& points, const double* target, double* value), (points, target, value))
KERNEL(void, stresslet_sum, (const Charges& points, const double* target, double* value), (points, target, value))
KERNEL(void, normal_stress_sum, (const Charges& points, const double* target, double* value), (points, target, value))

}  // namespace tanktread::stokes
