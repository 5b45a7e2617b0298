#include "surface/silhouette.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "surface/patch.hpp"
#include "surfaces.hpp"

namespace tanktread::surface {
namespace {

using std::numbers::pi;

/// Returns 4 pi A/P^2 of an ellipse. The perimeter is the integral of the speed over the angle by the trapezoidal rule, whose error is round-off.
double circularity_of_ellipse(double a, double b) {
  constexpr int n = 200;
  double perimeter = 0;
  for (int k = 0; k < n; ++k) perimeter += std::hypot(a * std::sin(2 * pi * k / n), b * std::cos(2 * pi * k / n)) * 2 * pi / n;
  return 4 * pi * pi * a * b / (perimeter * perimeter);
}

/// Returns the integral of |n_c|/2 over the surface, by the midpoint rule: the area of a projection in which each point is an image of two points.
double seen_twice(const spline::Space& space, const Net& x, int c) {
  constexpr int n = 30;
  double sum = 0;
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e)
    for (int k = 0; k < n * n; ++k) {
      const Jet at = jet(ElementPoints(space, x, e).patch(), (k % n + 0.5) / n, (k / n + 0.5) / n);
      sum += std::abs(at.s.cross(at.t)[c]) / (2 * n * n);
    }
  return sum;
}

TEST(Silhouette, OfAnEllipsoidIsAnEllipse) {
  const CubeMesh cube(8);
  const BezierMap map(cube.space);
  const Net x = cube.ellipsoid({1.4, 1.0, 0.8}, Vec3::Zero(), {30, -20, 10});
  const Vec3 axes(1.4, 1.0, 0.8);
  for (int c = 0; c < 3; ++c) {
    const double a = axes[(c + 1) % 3], b = axes[(c + 2) % 3];
    const Silhouette seen = silhouette(map, x, 3 * Vec3::Unit(c));
    for (const double area : {seen.area, seen.hull_area}) EXPECT_NEAR(area, pi * a * b, 5e-5);  // error of the mesh
    for (const double circularity : {seen.circularity, seen.hull_circularity}) EXPECT_NEAR(circularity, circularity_of_ellipse(a, b), 5e-5);
  }
  // the area in an oblique direction n is pi sqrt(sum of (n_i b_i c_i)^2)
  const Vec3 n = Vec3(1, 2, -1).normalized();
  EXPECT_NEAR(silhouette(map, x, n).area, pi * Vec3(n[0] * 1.0 * 0.8, n[1] * 1.4 * 0.8, n[2] * 1.4 * 1.0).norm(), 5e-5);
}

TEST(Silhouette, OfABentRodIsSmallerThanItsHullAndAHiddenHollowIsNotSeen) {
  const CubeMesh cube(10);
  const BezierMap map(cube.space);
  Net rod = cube.sphere(), hollow = rod;
  for (int a = 0; a < rod.rows(); ++a) {  // the axis of the rod is half a circle of radius 1 in the plane x1 x3
    const Vec3 x = rod.row(a);
    const double angle = pi / 2 * x[0], radius = 1 + 0.25 * x[2];
    rod.row(a) << radius * std::sin(angle), 0.25 * x[1], radius * std::cos(angle);
    if (x[0] < 0) hollow(a, 0) = x[0] * (1 - std::exp(-4 * (x[1] * x[1] + x[2] * x[2])));
  }
  const Silhouette bent = silhouette(map, rod, Vec3::UnitY()), side = silhouette(map, rod, Vec3::UnitX());
  EXPECT_NEAR(bent.area, seen_twice(cube.space, rod, 1), 2e-4);  // error of the midpoint rule at folds
  EXPECT_GT(bent.hull_area, 1.4 * bent.area);
  EXPECT_LT(bent.circularity, 0.6 * bent.hull_circularity);
  EXPECT_GT(side.hull_area, side.area - 1e-12);
  const Silhouette rear = silhouette(map, hollow, Vec3::UnitZ());
  EXPECT_NEAR(silhouette(map, hollow, Vec3::UnitX()).area, pi, 0.01);
  EXPECT_NEAR(rear.area, rear.hull_area, 2e-3);  // the rim of the hollow, seen from the side, is a line
  EXPECT_GT(seen_twice(cube.space, hollow, 2), 1.1 * rear.area);  // the bottom of the hollow is seen through its wall
}

TEST(Silhouette, OfARedCellAlongItsRimIsItsHull) {
  const CubeMesh cube(8);
  ParticleShape shape;
  shape.shape = "red cell", shape.radius = 1;
  const Net x = cube.shape(shape);
  const Silhouette rim = silhouette(BezierMap(cube.space), x, Vec3::UnitX()), face = silhouette(BezierMap(cube.space), x, Vec3::UnitZ());
  EXPECT_NEAR(rim.area, rim.hull_area, 5e-4);  // on this mesh the rim is not exactly plane
  EXPECT_NEAR(rim.circularity, rim.hull_circularity, 1e-3);
  EXPECT_NEAR(face.circularity, 1, 1e-5);
}

}  // namespace
}  // namespace tanktread::surface
