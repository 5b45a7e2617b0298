#include <cmath>

#include <gtest/gtest.h>

#include "accuracy/position.hpp"
#include "record/files/nodes.hpp"

namespace tanktread::accuracy {
namespace {

/// A part of the paraboloid z = (x² + y²)/4 over the unit square, in n x n cells of degree 2, which hold it exactly. `lift` is added to z.
output::StoredSurface paraboloid(int n, double lift) {
  output::StoredSurface surface;
  const int side = 2 * n + 1;  // nodes in a row
  surface.points.resize(side * side, 3);
  for (int a = 0; a < side; ++a)
    for (int b = 0; b < side; ++b) {
      const double x = a / (2. * n), y = b / (2. * n);
      surface.points.row(a * side + b) << x, y, (x * x + y * y) / 4 + lift;
    }
  for (int a = 0; a < n; ++a)
    for (int b = 0; b < n; ++b) {
      surface.cells.emplace_back();
      for (const auto& [i, j] : output::node_order(2)) surface.cells.back().push_back((2 * a + i) * side + 2 * b + j);
    }
  return surface;
}

TEST(Distances, VanishBetweenTwoMeshesOfOneSurface) {
  for (const double distance : distances(paraboloid(5, 0), paraboloid(3, 0))) EXPECT_LT(distance, 1e-9);
}

TEST(Distances, AreNormalToTheSurface) {
  const output::StoredSurface fine = paraboloid(4, 1e-3);
  const std::vector<double> found = distances(fine, paraboloid(3, 0));
  for (Eigen::Index k = 0; k < fine.points.rows(); ++k) {
    const double x = fine.points(k, 0), y = fine.points(k, 1);
    if (x == 0 || y == 0 || x == 1 || y == 1) continue;  // the nearest point may be on the edge
    EXPECT_NEAR(found[static_cast<std::size_t>(k)], 1e-3 / std::sqrt(1 + (x * x + y * y) / 4), 2e-6);
  }
}

TEST(Distances, AreUnknownFarAway) { EXPECT_TRUE(std::isnan(distances(paraboloid(2, 10), paraboloid(3, 0)).front())); }

}  // namespace
}  // namespace tanktread::accuracy
