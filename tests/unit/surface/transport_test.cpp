#include "surface/transport.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "surface/geometry.hpp"
#include "surfaces.hpp"

namespace tanktread::surface {
namespace {

/// Returns the control values of the rigid motion U + W x (x - centre). The spline represents this field exactly.
Net rigid(const Net& x, const Vec3& u, const Vec3& w, const Vec3& centre) {
  Net v(x.rows(), 3);
  for (Eigen::Index a = 0; a < x.rows(); ++a) v.row(a) = (u + w.cross(x.row(a).transpose() - centre)).transpose();
  return v;
}

TEST(Transport, ARigidMotionMovesTheCentroid) {
  const CubeMesh cube(3);
  const Net x = cube.crumpled(0.1).rowwise() + Eigen::RowVector3d(25, 0, 0);
  const Geometry geometry(cube.space);
  const Vec3 u(1.3, -0.2, 0.4), w(0.3, 0.5, -0.7), centre = geometry.measures(x).centroid;
  EXPECT_LT((centroid_velocity(geometry.bezier(), x, rigid(x, u, w, centre)) - u).norm(), 1e-12);
}

TEST(Transport, TheVelocityOfTheCentroidIsItsDerivative) {
  const CubeMesh cube(3);
  const Net x = cube.crumpled(0.1), v = cube.crumpled(0.3, 2);  // v changes the volume too
  const Geometry geometry(cube.space);
  const double e = 1e-5;
  const Vec3 difference = (geometry.measures(x + e * v).centroid - geometry.measures(x - e * v).centroid) / (2 * e);
  EXPECT_LT((centroid_velocity(geometry.bezier(), x, v) - difference).norm(), 1e-8);  // e^2, and round-off divided by e
}

/// An ellipsoid, deformed from a sphere, whose material circulates parallel to the plane x1 x3. With the semi-axes a and c along x1 and x3, a
/// material point moves along (x1, x3) = (a sin q, c cos q) times a constant, and its angle q grows at the rate `rate`.
struct TreadingEllipsoid {
  CubeMesh cube{6};
  BezierMap map{cube.space};
  Vec3 axes{1.4, 1, 0.7};
  double rate = 0.45;
  Net sphere = cube.sphere(), x = sphere * axes.asDiagonal(), v = Net::Zero(x.rows(), 3);
  TreadingEllipsoid() {
    v.col(0) = rate * axes[0] / axes[2] * x.col(2);
    v.col(2) = -rate * axes[2] / axes[0] * x.col(0);
  }
  TankTreading treading(const Net* unstressed) const { return tank_treading(map, x, v, unstressed, Vec3::Zero(), Vec3::Zero()); }
};

TEST(Transport, TheFrequencyIsThatOfTheMaterial) {
  const TreadingEllipsoid e;
  EXPECT_NEAR(e.treading(&e.sphere).frequency / e.rate, 1, 2e-3);  // weighted by length on the unstressed sphere; error of the chords: (1/36)^2
  EXPECT_NEAR(e.treading(nullptr).frequency / e.rate, 1, 2e-3);    // weighted by the time that a point spends on each part
}

TEST(Transport, ADropWithAStagnationPointDoesNotTankTread) {
  TreadingEllipsoid e;
  e.v.col(2) *= -1;  // stretches the ellipsoid
  EXPECT_EQ(e.treading(nullptr).frequency, 0);
  const double a = e.axes[0], c = e.axes[2], perimeter = 4 * a * std::comp_ellint_2(std::sqrt(1 - c * c / (a * a)));
  const double circulation = e.rate * (a / c - c / a) * std::numbers::pi * a * c;  // by Stokes' theorem
  EXPECT_NEAR(e.treading(nullptr).velocity / (circulation / perimeter), 1, 2e-3);  // error of the chords
}

TEST(Transport, ARotatingSphereTankTreadsAtTheVelocityOfItsEquator) {
  const CubeMesh cube(6);
  const double radius = 0.6, spin = 0.7;
  const Vec3 centre(3, 0.1, -0.2), u(1.5, 0, 0);
  ParticleShape shape;
  shape.radius = radius;
  shape.center = centre;
  const Net x = cube.shape(shape);
  const BezierMap map(cube.space);
  const auto treading = [&](const Vec3& w) { return tank_treading(map, x, rigid(x, u, w, centre), &x, centre, u); };
  // If rotated about x2, the side of larger x3 moves along x1. Error of chords and flat triangles: (1/36)^2 of the rim.
  EXPECT_NEAR(treading({0, spin, 0}).velocity, spin * radius, 1e-3 * spin * radius);
  EXPECT_NEAR(treading({0, -spin, 0}).velocity, -spin * radius, 1e-3 * spin * radius);
  EXPECT_NEAR(treading({0, spin, 0}).frequency, spin, 1e-3 * spin);
  EXPECT_NEAR(treading({spin, 0, 0}).velocity, 0, 1e-6);
  EXPECT_NEAR(treading({0, 0, spin}).velocity, 0, 1e-6);
}

}  // namespace
}  // namespace tanktread::surface
