#include "surface/shapes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/errors.hpp"
#include "surface/geometry.hpp"
#include "surfaces.hpp"

namespace tanktread::surface {
namespace {

ParticleShape red_cell_shape() {
  ParticleShape shape;
  shape.shape = "red cell";
  shape.radius = 1.5;
  shape.center = {1, -2, 0.5};
  shape.orientation = {0, 90, 0};  // its axis lies along x1
  return shape;
}

Net stress_free(const CubeMesh& cube, const ParticleShape& shape, double reduced_volume) {
  const LeastSquaresFit fit(cube.space);
  return stress_free_spheroid(fit, unit_sphere(cube.mesh, fit), shape, reduced_volume);
}

double reduced_volume(const Measures& m) { return 6 * std::sqrt(std::numbers::pi) * m.volume / std::pow(m.area, 1.5); }

TEST(StressFreeSpheroid, HasTheAreaOfTheRestingShapeAndTheRequestedReducedVolume) {
  const CubeMesh cube(12);
  const ParticleShape shape = red_cell_shape();
  const Measures resting = measures(cube.space, cube.shape(shape));
  for (const double v : {1.0, 0.95, 0.65}) {
    const Measures found = measures(cube.space, stress_free(cube, shape, v));
    EXPECT_NEAR(reduced_volume(found), v, 1e-4);
    EXPECT_NEAR(found.area / resting.area, 1, 1e-4);
    EXPECT_LT((found.centroid - shape.center).norm(), 1e-5);
    const Vec3 lengths = principal_axes(found).lengths;
    EXPECT_NEAR(lengths[0], lengths[1], 1e-4);  // the spheroid is oblate
    if (v < 0.9) {
      EXPECT_NEAR(found.second_moments(1, 1), found.second_moments(2, 2), 1e-4);  // axisymmetric about x1
      EXPECT_LT(found.second_moments(0, 0), 0.5 * found.second_moments(1, 1));
    }
  }
}

/// Only the errors of the fits change the area at a point; they decrease with mesh refinement.
TEST(StressFreeSpheroid, KeepsTheAreaOfEveryPiece) {
  double before = 1;
  for (const int n : {6, 12}) {
    const CubeMesh cube(n);
    const Net resting = cube.shape(red_cell_shape()), unstressed = stress_free(cube, red_cell_shape(), 0.95);
    double largest = 0;
    for (int e = 0; e < static_cast<int>(cube.space.elements.size()); ++e) {
      const auto area = [&](const Net& net) { return point(cube.space, net, {e, 0.5, 0.5}).jacobian; };
      largest = std::max(largest, std::abs(area(resting) / area(unstressed) - 1));
    }
    EXPECT_LT(largest, before / 4) << n;
    before = largest;
  }
  EXPECT_LT(before, 1e-2);
}

TEST(StressFreeSpheroid, OfASphereIsTheSphereAndOfASpheroidWithItsReducedVolumeTheSpheroid) {
  const CubeMesh cube(6);
  ParticleShape shape;
  EXPECT_LT((stress_free(cube, shape, 1) - cube.shape(shape)).norm() / cube.shape(shape).norm(), 1e-5);
  shape.shape = "spheroid";
  shape.semi_axes = {1.2, 0.7, 1.2};  // about x2
  const Net resting = cube.shape(shape);
  const double e = std::sqrt(1 - 0.49 / 1.44), area = 2 * std::numbers::pi * 1.44 * (1 + (1 - e * e) / e * std::atanh(e));
  const double v = 6 * std::sqrt(std::numbers::pi) * (4 * std::numbers::pi / 3 * 1.44 * 0.7) / std::pow(area, 1.5);
  EXPECT_LT((stress_free(cube, shape, v) - resting).norm() / resting.norm(), 1e-4);
}

TEST(StressFreeSpheroid, NeedsARestingShapeWithAnAxis) {
  const CubeMesh cube(3);
  ParticleShape shape;
  shape.shape = "ellipsoid";
  shape.semi_axes = {1, 0.9, 0.8};
  EXPECT_THROW(stress_free(cube, shape, 1), UserError);
}

}  // namespace
}  // namespace tanktread::surface
