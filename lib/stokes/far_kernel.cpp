#include "stokes/far_kernel.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/pack.hpp"

namespace tanktread::stokes {
namespace {

constexpr int packs = far_block / lanes;

/// Packs of targets that are summed for side by side.
constexpr int tile = packs < 4 ? packs : 4;

/// Nodes that all targets meet before the next ones are loaded: 48 or 72 bytes each.
constexpr int nodes_in_cache = 4096;

/// u[3 k + c] of target k, which has the coordinates given[0][k], and what else goes with it in given[1][k].
template <std::size_t Vectors, class Nodes>
void sums_by_blocks(const Nodes& nodes, const std::array<std::span<const Vec3>, Vectors>& given, double* u) {
  const int n = static_cast<int>(given[0].size());
  double block[3 * Vectors * far_block], sums[3 * far_block];
  std::fill_n(u, 3 * given[0].size(), 0.);
  for (int node = 0; node < nodes.n; node += nodes_in_cache) {
    const Nodes part = nodes.part(node, std::min(nodes_in_cache, nodes.n - node));
    for (int first = 0; first < n; first += far_block) {
      for (int l = 0; l < far_block; ++l)  // idle lanes repeat the last target
        for (std::size_t v = 0; v < Vectors; ++v)
          for (std::size_t c = 0; c < 3; ++c) block[far_block * (3 * v + c) + l] = given[v][std::min(first + l, n - 1)][c];
      far_sum(part, block, sums);
      for (int l = 0; l < std::min(far_block, n - first); ++l)
        for (int c = 0; c < 3; ++c) u[3 * (first + l) + c] += sums[far_block * c + l];
    }
  }
}

/// The targets of one tile.
void tile_sum(const PointForces& forces, const double* target, double* u) {
  Pack x0[tile], y0[tile], z0[tile], ux[tile] = {}, uy[tile] = {}, uz[tile] = {};
  for (int p = 0; p < tile; ++p) {
    x0[p] = load(target + lanes * p);
    y0[p] = load(target + far_block + lanes * p);
    z0[p] = load(target + 2 * far_block + lanes * p);
  }
  for (int k = 0; k < forces.n; ++k) {
    const double x = forces.x[k], y = forces.y[k], z = forces.z[k], fx = forces.fx[k], fy = forces.fy[k], fz = forces.fz[k];
#pragma GCC unroll 8
    for (int p = 0; p < tile; ++p) {
      const Pack rx = x - x0[p], ry = y - y0[p], rz = z - z0[p];
      const Pack inverse = inverse_root(rx * rx + ry * ry + rz * rz);
      const Pack along = (rx * fx + ry * fy + rz * fz) * (inverse * inverse);
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

void far_sums(const PointForces& forces, std::span<const Vec3> targets, double* u) { sums_by_blocks<1>(forces, {targets}, u); }

void node_sum(const PointForces& forces, const double* x0, double* u) {
  double ux = 0, uy = 0, uz = 0;
  for (int k = 0; k < forces.n; ++k) {
    const double rx = forces.x[k] - x0[0], ry = forces.y[k] - x0[1], rz = forces.z[k] - x0[2];
    const double square = rx * rx + ry * ry + rz * rz, inverse = square > 0 ? 1 / std::sqrt(square) : 0;
    const double along = (rx * forces.fx[k] + ry * forces.fy[k] + rz * forces.fz[k]) * (inverse * inverse);
    ux += inverse * (forces.fx[k] + rx * along);
    uy += inverse * (forces.fy[k] + ry * along);
    uz += inverse * (forces.fz[k] + rz * along);
  }
  u[0] = ux, u[1] = uy, u[2] = uz;
}

void far_sum(const Stresslets& nodes, const double* target, double* u) {
  for (int p = 0; p < packs; ++p) {
    Pack t[6], ux{}, uy{}, uz{};
    for (int c = 0; c < 6; ++c) t[c] = load(target + far_block * c + lanes * p);
    for (int k = 0; k < nodes.n; ++k) {
      const Pack rx = nodes.x[k] - t[0], ry = nodes.y[k] - t[1], rz = nodes.z[k] - t[2];
      const Pack inverse = inverse_root(rx * rx + ry * ry + rz * rz), square = inverse * inverse;
      const Pack velocity = rx * (nodes.vx[k] - t[3]) + ry * (nodes.vy[k] - t[4]) + rz * (nodes.vz[k] - t[5]);
      const Pack normal = rx * nodes.nx[k] + ry * nodes.ny[k] + rz * nodes.nz[k];
      const Pack strength = -6 * velocity * normal * (square * square * inverse);
      ux += strength * rx;
      uy += strength * ry;
      uz += strength * rz;
    }
    store(ux, u + lanes * p);
    store(uy, u + far_block + lanes * p);
    store(uz, u + 2 * far_block + lanes * p);
  }
}

void far_sums(const Stresslets& nodes, std::span<const Vec3> targets, std::span<const Vec3> v0, double* u) {
  sums_by_blocks<2>(nodes, {targets, v0}, u);
}

void node_sum(const Stresslets& nodes, const double* x0, const double* v0, double* u) {
  double ux = 0, uy = 0, uz = 0;
  for (int k = 0; k < nodes.n; ++k) {
    const double rx = nodes.x[k] - x0[0], ry = nodes.y[k] - x0[1], rz = nodes.z[k] - x0[2];
    const double square = rx * rx + ry * ry + rz * rz, inverse = square > 0 ? 1 / std::sqrt(square) : 0;
    const double velocity = rx * (nodes.vx[k] - v0[0]) + ry * (nodes.vy[k] - v0[1]) + rz * (nodes.vz[k] - v0[2]);
    const double normal = rx * nodes.nx[k] + ry * nodes.ny[k] + rz * nodes.nz[k];
    const double strength = -6 * velocity * normal * inverse * inverse * inverse * inverse * inverse;
    ux += strength * rx;
    uy += strength * ry;
    uz += strength * rz;
  }
  u[0] = ux, u[1] = uy, u[2] = uz;
}

void StokesletKernel::sum(const Charges& p, const double* target, double* value) {
  far_sum(PointForces{p.n, p.x, p.y, p.z, p.q[0], p.q[1], p.q[2]}, target, value);
}

void StressletKernel::sum(const Charges& points, const double* target, double* value) {
  const auto& q = points.q;
  for (int p = 0; p < packs; ++p) {
    Pack t[3], u[3] = {};
    for (int c = 0; c < 3; ++c) t[c] = load(target + far_block * c + lanes * p);
    for (int k = 0; k < points.n; ++k) {
      const Pack rx = points.x[k] - t[0], ry = points.y[k] - t[1], rz = points.z[k] - t[2];
      const Pack inverse = inverse_root(rx * rx + ry * ry + rz * rz), square = inverse * inverse;
      const Pack form =
          rx * (q[0][k] * rx) + ry * (q[1][k] * ry) + rz * (q[2][k] * rz) + 2 * (rx * (q[3][k] * ry + q[4][k] * rz) + ry * (q[5][k] * rz));
      const Pack strength = -6 * form * (square * square * inverse);
      u[0] += strength * rx;
      u[1] += strength * ry;
      u[2] += strength * rz;
    }
    for (int c = 0; c < 3; ++c) store(u[c], value + far_block * c + lanes * p);
  }
}

void NormalStressKernel::sum(const Charges& points, const double* target, double* value) {
  const auto& n = points.q;
  for (int p = 0; p < packs; ++p) {
    Pack t[3], u[6] = {};
    for (int c = 0; c < 3; ++c) t[c] = load(target + far_block * c + lanes * p);
    for (int k = 0; k < points.n; ++k) {
      const Pack rx = points.x[k] - t[0], ry = points.y[k] - t[1], rz = points.z[k] - t[2];
      const Pack inverse = inverse_root(rx * rx + ry * ry + rz * rz), square = inverse * inverse;
      const Pack strength = -6 * (rx * n[0][k] + ry * n[1][k] + rz * n[2][k]) * (square * square * inverse);
      const Pack sx = strength * rx, sy = strength * ry;
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

}  // namespace tanktread::stokes
