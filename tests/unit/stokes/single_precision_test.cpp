#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "stokes/kernels/far_kernel.hpp"

namespace tanktread::stokes {
namespace single_precision_test {

/// Nodes with random strengths on a sphere about a point far from the origin, in any unit of length. Targets are close to some of the nodes.
struct Scene {
  static constexpr int n = 1000;
  std::vector<double> x[3], q[6];
  double target[6 * far_block];

  explicit Scene(double unit) {
    std::mt19937 random(3);
    std::normal_distribution<> normal;
    for (int k = 0; k < n; ++k) {
      const Vec3 at = unit * (Vec3(7, -2, 3) + Vec3(normal(random), normal(random), normal(random)).normalized());
      for (int c = 0; c < 3; ++c) x[c].push_back(at[c]);
      for (auto& component : q) component.push_back(normal(random));
    }
    for (int l = 0; l < far_block; ++l)
      for (int c = 0; c < 3; ++c) {  // the first target coincides with a node, the others are at decreasing distances from one
        target[far_block * c + l] = x[c][static_cast<std::size_t>(10 * l)] + (l > 0 ? unit * normal(random) * std::pow(0.5, l) : 0);
        target[far_block * (3 + c) + l] = normal(random);
      }
  }

  Stresslets stresslets() const {
    return {n, x[0].data(), x[1].data(), x[2].data(), q[0].data(), q[1].data(), q[2].data(), q[3].data(), q[4].data(), q[5].data()};
  }
  Charges charges() const { return stokes::charges(x, q); }

  /// Returns sum 10 / r^power over the nodes that do not coincide with target l, of the order of the sum of the magnitudes of the terms.
  double magnitude(int l, int power) const {
    double sum = 0;
    for (std::size_t k = 0; k < n; ++k) {
      Vec3 r;
      for (int c = 0; c < 3; ++c) r[c] = x[c][k] - target[far_block * c + l];
      if (r.norm() > 0) sum += 10 / std::pow(r.norm(), power);
    }
    return sum;
  }
};

/// Returns the largest error divided by the sum of the magnitudes of the terms.
double largest_error(const Scene& scene, int power, const double* single, const double* full) {
  double largest = 0;
  for (int l = 0; l < far_block; ++l)
    for (int c = 0; c < 3; ++c)
      largest = std::max(largest, std::abs(single[far_block * c + l] - full[far_block * c + l]) / scene.magnitude(l, power));
  return largest;
}

// The bounds are 4 rounding errors of single precision, and 16 for a stresslet, which contains the fifth power of a rounded value. The kernel
// stores the rounding errors of the positions in addition to the rounded positions; without them, the errors are a hundred times larger.
TEST(SinglePrecision, HasOnlyRoundingErrorsForCloseNodesAndInAnyUnit) {
  const double rounding = 0x1p-24;
  for (const double unit : {1e-9, 1e-6, 1., 1e9}) {
    const Scene scene(unit);
    double single[3 * far_block], full[3 * far_block];
    stokeslet_sum_in_single(scene.charges(), scene.target, single), stokeslet_sum(scene.charges(), scene.target, full);
    EXPECT_LT(largest_error(scene, 1, single, full), 4 * rounding) << unit;
    far_sum_in_single(scene.stresslets(), scene.target, single), far_sum(scene.stresslets(), scene.target, full);
    EXPECT_LT(largest_error(scene, 2, single, full), 16 * rounding) << unit;
    stresslet_sum_in_single(scene.charges(), scene.target, single), stresslet_sum(scene.charges(), scene.target, full);
    EXPECT_LT(largest_error(scene, 2, single, full), 16 * rounding) << unit;
  }
}

TEST(SinglePrecision, GivesATargetTheSameValueForAnyNeighbours) {
  const Scene scene(1);
  double together[3 * far_block], alone[3 * far_block], repeated[6 * far_block];
  const auto same = [&](auto sum, const auto& nodes) {
    sum(nodes, scene.target, together);
    for (int l = 0; l < far_block; ++l) {
      for (int c = 0; c < 6; ++c) std::fill_n(repeated + far_block * c, far_block, scene.target[far_block * c + l]);
      sum(nodes, repeated, alone);
      for (int c = 0; c < 3; ++c) EXPECT_EQ(alone[far_block * c], together[far_block * c + l]) << l;
    }
  };
  same(stokeslet_sum_in_single, scene.charges());
  same(far_sum_in_single, scene.stresslets());
  same(stresslet_sum_in_single, scene.charges());
}

}  // namespace single_precision_test
}  // namespace tanktread::stokes
