#include "surface/transport.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "surfaces.hpp"

namespace tanktread::surface {
namespace {

/// Control values of U + W x (x - centre): exact.
Net rigid(const Net& x, const Vec3& u, const Vec3& w, const Vec3& centre) {
  Net v(x.rows(), 3);
  for (Eigen::Index a = 0; a < x.rows(); ++a) v.row(a) = (u + w.cross(x.row(a).transpose() - centre)).transpose();
  return v;
}

TEST(Transport, ARigidMotionCarriesTheCentroidWithIt) {
  const CubeMesh cube(3);
  const Net x = cube.crumpled(0.1).rowwise() + Eigen::RowVector3d(25, 0, 0);
  const Geometry geometry(cube.space);
  const Vec3 u(1.3, -0.2, 0.4), w(0.3, 0.5, -0.7), centre = geometry.measures(x).centroid;
  EXPECT_LT((centroid_velocity(geometry, x, rigid(x, u, w, centre)) - u).norm(), 1e-11);  // round-off of differences of volumes
}

TEST(Transport, TheVelocityOfTheCentroidIsItsDerivative) {
  const CubeMesh cube(3);
  const Net x = cube.crumpled(0.1), v = cube.crumpled(0.3, 2);  // changes the volume too
  const Geometry geometry(cube.space);
  const double e = 1e-5;
  const Vec3 difference = (geometry.measures(x + e * v).centroid - geometry.measures(x - e * v).centroid) / (2 * e);
  EXPECT_LT((centroid_velocity(geometry, x, v) - difference).norm(), 1e-8);  // e^2 and round-off over e
}

TEST(Transport, ATurningSphereTreadsAtItsRim) {
  const CubeMesh cube(6);
  const double radius = 0.6, spin = 0.7;
  const Vec3 centre(3, 0.1, -0.2), u(1.5, 0, 0);
  ParticleShape shape;
  shape.radius = radius;
  shape.center = centre;
  const Net x = cube.shape(shape);
  const auto treading = [&](const Vec3& w) { return tank_treading_velocity(cube.space, x, rigid(x, u, w, centre), centre, u); };
  // Turned about x2 the side of larger x3 moves on. Chords and flat triangles: (1/36)^2 of the rim.
  EXPECT_NEAR(treading({0, spin, 0}), spin * radius, 1e-3 * spin * radius);
  EXPECT_NEAR(treading({0, -spin, 0}), -spin * radius, 1e-3 * spin * radius);
  EXPECT_NEAR(treading({spin, 0, 0}), 0, 1e-6);
  EXPECT_NEAR(treading({0, 0, spin}), 0, 1e-6);
}

}  // namespace
}  // namespace tanktread::surface
