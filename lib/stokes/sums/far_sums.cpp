#include "stokes/sums/far_sums.hpp"

#include <algorithm>
#include <array>

#include "base/threads.hpp"

namespace tanktread::stokes {
namespace {

/// Number of nodes, of 48 or 72 bytes each, that fit into the cache and are summed for all targets before the next nodes are loaded.
constexpr int nodes_in_cache = 4096;

/// Computes u[3 k + c], component c of the sum over all nodes at target k. sum(nodes, targets, sums) computes the sums over one block of nodes at one
/// block of targets. Target k has the position given[0][k], followed by the vector given[1][k] if Vectors is 2.
template <std::size_t Vectors, class Nodes, class Sum>
void sums_by_blocks(const Nodes& nodes, const std::array<std::span<const Vec3>, Vectors>& given, double* u, const Sum& sum) {
  const int n = static_cast<int>(given[0].size());
  std::fill_n(u, 3 * given[0].size(), 0.);
  for (int node = 0; node < nodes.n; node += nodes_in_cache) {
    const Nodes part = nodes.part(node, std::min(nodes_in_cache, nodes.n - node));
    each_item((n + far_block - 1) / far_block, [&](int number) {
      double block[3 * Vectors * far_block], sums[3 * far_block];
      const int first = number * far_block;
      for (int l = 0; l < far_block; ++l)  // unused lanes repeat the last target
        for (std::size_t v = 0; v < Vectors; ++v)
          for (std::size_t c = 0; c < 3; ++c) block[far_block * (3 * v + c) + l] = given[v][std::min(first + l, n - 1)][c];
      sum(part, block, sums);
      for (int l = 0; l < std::min(far_block, n - first); ++l)
        for (int c = 0; c < 3; ++c) u[3 * (first + l) + c] += sums[far_block * c + l];
    });
  }
}

}  // namespace

void far_sums(const Charges& forces, std::span<const Vec3> targets, double* u) { kernel_sums(stokeslet_sum, forces, targets, u); }

void far_sums(const Stresslets& nodes, std::span<const Vec3> targets, std::span<const Vec3> v0, double* u) {
  sums_by_blocks<2>(nodes, {targets, v0}, u, far_sum);
}

void kernel_sums(KernelSum kernel, const Charges& points, std::span<const Vec3> targets, double* u) {
  sums_by_blocks<1>(points, {targets}, u, kernel);
}

}  // namespace tanktread::stokes
