// Tests of the rate of change of the shape.

#include "surface/transport.hpp"

#include <cmath>
#include <numeric>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "surfaces.hpp"

namespace tanktread::surface {
namespace {

struct Body {
  CubeMesh cube{4, spline::ExtraordinaryRule::catmull_clark};
  BezierMap map{cube.space};
  Net x;
  Body(const Vec3& semi_axes, const Vec3& centre) : x(cube.ellipsoid(semi_axes, Vec3::Zero(), centre)) {}
  double speed(const Net& v, bool along_x1 = false) const {
    std::vector<int> all(static_cast<std::size_t>(map.n_elements()));
    std::iota(all.begin(), all.end(), 0);
    return shape_velocity(shape_velocity_sums(map, x, v, 1, all), along_x1);
  }
};

TEST(ShapeVelocity, OfASphereInExtensionIsTheRootMeanSquareOfTheStrainRate) {
  const Body sphere(Vec3(1, 1, 1), Vec3(3, -1, 2));
  const Vec3 strain(1, -0.25, -0.75);
  const Net v = (sphere.x.rowwise() - Vec3(3, -1, 2).transpose()) * strain.asDiagonal();
  // The mean square of n.E.n on a sphere is 2/15 E:E; the error of the sphere on 96 elements is 1e-3.
  EXPECT_NEAR(sphere.speed(v), std::sqrt(2. / 15) * strain.norm(), 2e-3);
}

TEST(ShapeVelocity, OfARigidTranslationIsZeroExceptAcrossATube) {
  const Body body(Vec3(1.2, 1, 0.7), Vec3(0, 1, 0));
  const auto translated = [&](const Vec3& u) { return Net(u.transpose().replicate(body.x.rows(), 1)); };
  EXPECT_LT(body.speed(translated({1, -2, 3})), 1e-7);  // of a velocity of 3.7; quadrature error with three Gauss points per direction
  EXPECT_LT(body.speed(translated({1, 0, 0}), true), 1e-7);
  EXPECT_GT(body.speed(translated({0, 0.1, 0}), true), 0.03);
}

// A rotating sphere keeps its shape: only the error of its net moves, and this error is of high degree.
TEST(ShapeVelocity, OfARotatingSphereIsTheErrorOfItsShape) {
  const Body sphere(Vec3(1, 1, 1), Vec3::Zero());
  Net v(sphere.x.rows(), 3);
  for (Eigen::Index i = 0; i < v.rows(); ++i) v.row(i) = Vec3(0.3, 1, -0.5).cross(sphere.x.row(i).transpose()).transpose();
  EXPECT_LT(sphere.speed(v), 1e-6);
}

}  // namespace
}  // namespace tanktread::surface
