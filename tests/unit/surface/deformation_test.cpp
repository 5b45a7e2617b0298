#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>

#include "base/indices.hpp"
#include "surface/extremes.hpp"
#include "surface/geometry.hpp"
#include "surfaces.hpp"
#include "tests/shape_measures.hpp"

namespace tanktread::surface {
namespace {

struct Axes {
  double longest, shortest, angle;
};
/// Returns the semi-axes of the ellipse x.A x = 1, and the angle of the long axis with the first coordinate, in degrees.
Axes ellipse(const Eigen::Matrix2d& a) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver(a);
  const Eigen::Vector2d v = solver.eigenvectors().col(0);
  double angle = std::atan2(v[1], v[0]) * 180 / std::numbers::pi;
  if (angle > 90) angle -= 180;
  if (angle <= -90) angle += 180;
  return {1 / std::sqrt(solver.eigenvalues()[0]), 1 / std::sqrt(solver.eigenvalues()[1]), angle};
}
Eigen::Matrix2d in_plane(const Mat3& m) { return (Eigen::Matrix2d() << m(0, 0), m(0, 2), m(2, 0), m(2, 2)).finished(); }

TEST(Deformation, TheLargestCoordinateIsNotSoughtAtTheHighestBezierPoint) {
  spline::Space space;
  space.n_points = 16;
  space.elements.emplace_back();
  space.elements[0].points = indices(16);
  space.elements[0].extraction = std::make_shared<const Eigen::MatrixXd>(Eigen::MatrixXd::Identity(16, 16));
  Net net = Net::Zero(16, 3);
  net.col(0) << -5, -7, 0, -5, -5, -4, -3, -5, -6, -3, -2, -1, -12, -1, -4, -6;  // the highest one is on a side, the maximum is inside
  const Patches patches(BezierMap(space), net);
  EXPECT_NEAR(coordinate_range(patches, 0).largest, position(patches[0], 0.7336, 0.5846)[0], 1e-6);
}

TEST(Deformation, OfAnEllipsoidInAnyPositionIsThatOfItsSectionAndItsMoments) {
  ParticleShape shape;
  shape.shape = "ellipsoid";
  shape.semi_axes = Vec3(1.6, 0.9, 0.7);
  shape.orientation = Vec3(10, -35, 20);
  shape.center = Vec3(0.3, -0.2, 5);
  const Mat3 map = shape.rotation() * shape.semi_axes->asDiagonal();
  const Mat3 moments = map * map.transpose();
  const Axes section = ellipse(in_plane(moments.inverse()));
  const Axes inertia = ellipse(in_plane(moments).inverse());
  double before = 1;
  for (const int n : {6, 12, 24}) {
    const CubeMesh cube(n);
    const Deformation d = deformation(Geometry(cube.space), cube.shape(shape));
    const double error = std::abs(d.taylor_surface - (section.longest - section.shortest) / (section.longest + section.shortest));
    EXPECT_LT(error, before / 4);  // the error of the fit at two points
    before = error;
    if (n == 24) {
      EXPECT_LT(error, 1e-6);
      EXPECT_NEAR(d.taylor_inertia, (inertia.longest - inertia.shortest) / (inertia.longest + inertia.shortest), 1e-9);
      EXPECT_NEAR(d.inclination, inertia.angle, 1e-7);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(d.lengths[c], 2 * std::sqrt(moments(c, c)), 3e-6);
    }
  }
}

TEST(Deformation, ExtremesOfAnIrregularSurfaceAgreeWithDenseSampling) {
  const CubeMesh cube(4);
  for (const unsigned seed : {1u, 2u, 3u}) {
    const Net net = cube.crumpled(0.08, seed);
    const Geometry geometry(cube.space);
    const Patches patches(geometry.bezier(), net);
    const Vec3 centre = geometry.measures(net).centroid;
    const Range distance = section_distances(patches, centre);
    Range coordinate[3];
    for (int c = 0; c < 3; ++c) coordinate[c] = coordinate_range(patches, c);

    constexpr int cells = 60;
    double low[3], high[3], nearest = 1e9, farthest = 0;
    for (int c = 0; c < 3; ++c) low[c] = 1e9, high[c] = -1e9;
    for (int e = 0; e < patches.size(); ++e) {
      Vec3 y[cells + 1][cells + 1];
      for (int j = 0; j <= cells; ++j) {
        for (int i = 0; i <= cells; ++i) {
          const Vec3 x = position(patches[e], double(i) / cells, double(j) / cells);
          y[j][i] = x - centre;
          for (int c = 0; c < 3; ++c) low[c] = std::min(low[c], x[c]), high[c] = std::max(high[c], x[c]);
          for (const Vec3& before : {i > 0 ? y[j][i - 1] : y[j][i], j > 0 ? y[j - 1][i] : y[j][i]}) {
            if (before[1] * y[j][i][1] >= 0) continue;
            const Vec3 cut = before + before[1] / (before[1] - y[j][i][1]) * (y[j][i] - before);
            nearest = std::min(nearest, std::hypot(cut[0], cut[2]));
            farthest = std::max(farthest, std::hypot(cut[0], cut[2]));
          }
        }
      }
    }
    // `spacing` is an upper bound of the error of the sampled extremes, about the curvature times the square of the distance between samples (1/240
    // of the side of a face). Points of the plane section are interpolated linearly between samples, with an error of the same order.
    const double spacing = 2e-4;
    for (int c = 0; c < 3; ++c) {
      EXPECT_GE(coordinate[c].largest, high[c]);
      EXPECT_LE(coordinate[c].largest, high[c] + spacing);
      EXPECT_LE(coordinate[c].smallest, low[c]);
      EXPECT_GE(coordinate[c].smallest, low[c] - spacing);
    }
    EXPECT_NEAR(distance.largest, farthest, spacing);
    EXPECT_NEAR(distance.smallest, nearest, spacing);
  }
}

TEST(Deformation, TurnsWithTheEllipsoid) {
  // The mesh is rotated about x2 together with the ellipsoid. The section x2 = centre_2 is therefore the same curve on the surface, and the values
  // agree to round-off.
  const CubeMesh cube(6);
  ParticleShape shape;
  shape.shape = "ellipsoid";
  shape.semi_axes = Vec3(1.5, 1.0, 0.8);
  const Deformation aligned = deformation(Geometry(cube.space), cube.shape(shape));
  EXPECT_NEAR(aligned.inclination, 0, 1e-10);
  shape.orientation = Vec3(0, -25, 0);  // rotates x1 towards x3
  const Deformation turned = deformation(Geometry(cube.space), cube.shape(shape));
  EXPECT_NEAR(turned.taylor_surface, aligned.taylor_surface, 1e-10);
  EXPECT_NEAR(turned.taylor_inertia, aligned.taylor_inertia, 1e-12);
  EXPECT_NEAR(turned.inclination, 25, 1e-9);
}

TEST(Deformation, AnUprightParticleIsInclinedBy90DegreesForAnyRounding) {
  const CubeMesh cube(4);
  ParticleShape shape;
  shape.shape = "ellipsoid";
  shape.semi_axes = Vec3(0.8, 1.0, 1.5);
  for (const double tilt : {0.0, 1e-10, -1e-10}) {  // degrees; far above the round-off of the moments
    shape.orientation = Vec3(0, tilt, 0);
    EXPECT_NEAR(deformation(Geometry(cube.space), cube.shape(shape)).inclination, 90, 1e-9) << tilt;
  }
}

TEST(Deformation, InclinationIsUndefinedIfTheTwoSemiAxesInThePlaneAreEqual) {
  const CubeMesh cube(3);  // here a fitted sphere has equal semi-axes to round-off; on four elements they differ by 2.5e-7
  for (const double radius : {1.0, 4e-6}) {
    const auto inclination = [&](const Vec3& axes) {
      ParticleShape shape;
      shape.shape = "ellipsoid";
      shape.semi_axes = radius * axes;
      return deformation(Geometry(cube.space), cube.shape(shape)).inclination;
    };
    EXPECT_TRUE(std::isnan(inclination(Vec3(1, 1, 1))));
    EXPECT_TRUE(std::isnan(inclination(Vec3(1 + 0.8e-6, 1, 1))));
    EXPECT_NEAR(inclination(Vec3(1 + 1.2e-6, 1, 1)), 0, 1e-3);  // round-off of the moments divided by the difference
    EXPECT_NEAR(inclination(Vec3(1, 1, 1 + 1.2e-6)), 90, 1e-3);
    EXPECT_TRUE(std::isnan(inclination(Vec3(1, 2, 1)))) << "the axes in the plane are equal";
    EXPECT_NEAR(inclination(Vec3(1, 1, 0.5)), 0, 1e-9) << "only the plane's own axes matter";
  }
}

TEST(PrincipalAxes, AreDefinedIfTheyDiffer) {
  const CubeMesh cube(4);
  const auto axes = [&](const Vec3& lengths) {
    ParticleShape shape;
    shape.shape = "ellipsoid";
    shape.semi_axes = lengths;
    return principal_axes(Geometry(cube.space).measures(cube.shape(shape)));
  };
  const PrincipalAxes sphere = axes(Vec3(1, 1, 1)), prolate = axes(Vec3(1, 2, 1)), oblate = axes(Vec3(1, 2, 2)), all = axes(Vec3(1, 2, 3));
  EXPECT_FALSE(sphere.longest_defined || sphere.shortest_defined);
  EXPECT_TRUE(prolate.longest_defined && !prolate.shortest_defined);
  EXPECT_TRUE(!oblate.longest_defined && oblate.shortest_defined);
  EXPECT_TRUE(all.longest_defined && all.shortest_defined);
}

TEST(Deformation, ExtentsAreAlsoFoundOnSidesAndCornersOfElements) {
  // The poles x_i = +-a_i of an aligned ellipsoid are at element corners for even n, in the middle of elements for odd n.
  for (const int n : {5, 6}) {
    const CubeMesh cube(n);
    const Deformation d = deformation(Geometry(cube.space), cube.ellipsoid({1.3, 1.0, 0.8}));
    EXPECT_NEAR(d.lengths[0], 2.6, 1e-3);
    EXPECT_NEAR(d.lengths[1], 2.0, 1e-3);
    EXPECT_NEAR(d.lengths[2], 1.6, 1e-3);
  }
}

}  // namespace
}  // namespace tanktread::surface
