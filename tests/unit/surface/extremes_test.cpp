#include "surface/extremes.hpp"

#include <numbers>
#include <numeric>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "base/errors.hpp"
#include "base/indices.hpp"
#include "surface/geometry.hpp"
#include "surfaces.hpp"

namespace tanktread::surface {
namespace {

TEST(Extremes, OfAUnionAreTheWidestOfItsParts) {
  const CubeMesh cube(6);
  const Geometry geometry(cube.space);
  for (const double amplitude : {0.08, 1e-3, 1e-4})
    for (const unsigned seed : {1u, 2u, 3u}) {
      const Net net = cube.crumpled(amplitude, seed);
      const Vec3 centre = geometry.measures(net).centroid;
      std::vector<int> all, parts[3];
      for (int e = 0; e < geometry.bezier().n_elements(); ++e) {
        all.push_back(e);
        parts[e < 40 ? 0 : e % 2 + 1].push_back(e);
      }
      const auto whole = geometry.extremes(net, centre, all);
      std::array<Range, Geometry::n_extremes> together;
      for (const auto& part : parts) {
        const auto of_part = geometry.extremes(net, centre, part);
        for (std::size_t k = 0; k < together.size(); ++k) together[k] = wider(together[k], of_part[k]);
      }
      for (std::size_t k = 0; k < together.size(); ++k) {
        EXPECT_NEAR(together[k].smallest, whole[k].smallest, 1e-14) << amplitude;  // round-off of one Newton iteration
        EXPECT_NEAR(together[k].largest, whole[k].largest, 1e-14) << amplitude;
      }
    }
}

TEST(Extremes, OfNoElementsAreEmptyAndASurfaceThatThePlaneMissesIsRejected) {
  const CubeMesh cube(3);
  const Geometry geometry(cube.space);
  const Net net = cube.sphere();
  for (const Range& range : geometry.extremes(net, Vec3::Zero(), {})) EXPECT_GT(range.smallest, range.largest);
  Measures measures = geometry.measures(net);
  measures.centroid[1] = 2;
  EXPECT_THROW(Geometry::deformation(measures, geometry.extremes(net, measures.centroid, indices(cube.space.elements.size()))), RunFailure);
}

// If the section is nearly a circle, samples on chords do not distinguish near from far.
TEST(Extremes, OfACoarsePolarSphereAreInOrderInEveryPlane) {
  const spline::PolarMesh mesh{8, 5, spline::PoleRule::c1};
  const spline::Space space = spline::space(mesh);
  ParticleShape shape;
  shape.radius = 1;
  const Net sphere = resting_shape(space, mesh, 2, shape);
  const BezierMap map(space);
  std::vector<int> all(space.elements.size());
  std::iota(all.begin(), all.end(), 0);
  for (const double tilt : {0.0, 0.3, 0.9, std::numbers::pi / 2})
    for (int turn = 0; turn < 90; ++turn) {
      const Mat3 q = (Eigen::AngleAxisd(tilt, Vec3::UnitX()) * Eigen::AngleAxisd(turn * std::numbers::pi / 90, Vec3::UnitZ())).toRotationMatrix();
      const Range range = section_distances(Patches(map, sphere * q.transpose(), all), Vec3::Zero());
      EXPECT_LE(range.smallest, range.largest) << tilt << " " << turn;
      EXPECT_NEAR(range.smallest, 1, 0.02) << tilt << " " << turn;  // the error with eight elements around
      EXPECT_NEAR(range.largest, 1, 0.02) << tilt << " " << turn;
    }
}

}  // namespace
}  // namespace tanktread::surface
