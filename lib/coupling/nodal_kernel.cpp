#include <cmath>
#include <cstring>

#include "coupling/nodal_operator.hpp"

namespace tanktread::coupling {

namespace {

using Tile = double __attribute__((vector_size(nodal_tile * sizeof(double))));

Tile load(const double* a) {
  Tile t;
  std::memcpy(&t, a, sizeof t);
  return t;
}

double sum(const Tile& t) {
  double s = 0;
  for (int l = 0; l < nodal_tile; ++l) s += t[l];
  return s;
}

Tile inverse_root(const Tile& a) {
  Tile root;
  for (int l = 0; l < nodal_tile; ++l) root[l] = std::sqrt(a[l]);
  return a > 0 ? 1 / root : Tile{};
}

}  // namespace

void nodal_sum(int n, const double* const (&node)[3], const double* const (&force)[3], const double* x0, double* u) {
  Tile sums[3 * nodal_block] = {};
  for (int k = 0; k < n; k += nodal_tile) {
    const Tile x = load(node[0] + k), y = load(node[1] + k), z = load(node[2] + k);
    const Tile fx = load(force[0] + k), fy = load(force[1] + k), fz = load(force[2] + k);
#pragma GCC unroll 4
    for (int l = 0; l < nodal_block; ++l) {
      const Tile rx = x - x0[3 * l], ry = y - x0[3 * l + 1], rz = z - x0[3 * l + 2];
      const Tile inverse = inverse_root(rx * rx + ry * ry + rz * rz);
      const Tile along = (rx * fx + ry * fy + rz * fz) * (inverse * inverse);
      sums[3 * l] += inverse * (fx + rx * along);
      sums[3 * l + 1] += inverse * (fy + ry * along);
      sums[3 * l + 2] += inverse * (fz + rz * along);
    }
  }
  for (int c = 0; c < 3 * nodal_block; ++c) u[c] = sum(sums[c]);
}

}  // namespace tanktread::coupling
