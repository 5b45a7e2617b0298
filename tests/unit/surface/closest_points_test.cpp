// Tests of the closest points of two surfaces, against brute force and known results.

#include <algorithm>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "spline/extraction.hpp"
#include "spline/t_mesh.hpp"
#include "surface/closest_points.hpp"
#include "surface/shapes.hpp"
#include "surface/walls/tube_wall.hpp"

namespace tanktread::surface {
namespace {

struct Shape {
  spline::TMesh mesh = spline::cube(3);
  spline::Space space = spline::space(mesh, spline::ExtraordinaryRule::g1);
  BezierMap map{space};
  Net sphere = resting_shape(space, mesh, {});

  /// Returns an irregular ellipsoid about a centre.
  Net bumpy(std::mt19937& random, const Vec3& centre) const {
    std::uniform_real_distribution<double> number(-1, 1);
    Mat3 stretch;
    for (int k = 0; k < 9; ++k) stretch(k) = (k % 4 == 0 ? 1 : 0) + 0.25 * number(random);
    Net x = sphere * stretch;
    for (Eigen::Index i = 0; i < x.rows(); ++i) x.row(i) *= 1 + 0.1 * number(random);
    return x.rowwise() + centre.transpose();
  }
};

ClosestPoints closest(const Shape& shape, const Net& a, const Net& b, double beyond = 1e9) {
  const Patches first(shape.map, a), second(shape.map, b);
  return closest_points(ElementBoxes(first), ElementBoxes(second), 1e-8, beyond);
}

/// Returns the distance on a grid in each element. The grid is so fine that the error is below 5e-3 for these shapes.
double by_brute_force(const Shape& shape, const Net& a, const Net& b) {
  constexpr int n = 12;
  const auto points = [&](const Net& net) {
    const Patches patches(shape.map, net);
    std::vector<Vec3> all;
    for (int e = 0; e < patches.size(); ++e)
      for (int k = 0; k <= n; ++k)
        for (int l = 0; l <= n; ++l) all.push_back(position(patches[e], double(k) / n, double(l) / n));
    return all;
  };
  double least = 1e9;
  const std::vector<Vec3> first = points(a), second = points(b);
  for (const Vec3& x : first)
    for (const Vec3& y : second) least = std::min(least, (x - y).squaredNorm());
  return std::sqrt(least);
}

TEST(ClosestPoints, OfRandomSurfacesAreThoseOfAFineGrid) {
  const Shape shape;
  std::mt19937 random(5);
  std::normal_distribution<double> number;
  for (int trial = 0; trial < 4; ++trial) {
    const Vec3 apart = 2.6 * Vec3(number(random), number(random), number(random)).normalized();
    const Net a = shape.bumpy(random, Vec3::Zero()), b = shape.bumpy(random, apart);
    const ClosestPoints found = closest(shape, a, b);
    const double on_grid = by_brute_force(shape, a, b);
    EXPECT_LE(found.gap, on_grid + 1e-12) << trial;
    EXPECT_GE(found.gap, on_grid - 5e-3) << trial;
    EXPECT_NEAR((found.second - found.first).norm(), found.gap, 1e-14);
    EXPECT_NEAR(closest(shape, b, a).gap, found.gap, 2e-8);
  }
}

/// The second surface is the first one, moved along its own third axis. By symmetry, the two tops are the closest points.
TEST(ClosestPoints, OfEqualSurfacesAboveEachOtherAreTheirTops) {
  const Shape shape;
  const Patches patches(shape.map, shape.sphere);
  double top = -1;
  for (int e = 0; e < patches.size(); ++e)
    for (const double s : {0., 0.5, 1.})
      for (const double t : {0., 0.5, 1.}) top = std::max(top, position(patches[e], s, t)[2]);
  for (const double gap : {1., 1e-2, 1e-4}) {
    const Net above = shape.sphere.rowwise() + Eigen::RowVector3d(0, 0, 2 * top + gap);
    const ClosestPoints found = closest(shape, shape.sphere, above);
    EXPECT_NEAR(found.gap, gap, 2e-8) << gap;
    if (gap > 1e-3) {
      EXPECT_LT(found.first.head<2>().norm(), 1e-3) << gap;
    }
  }
}

/// Newton's method finds the same two points from two different starts, and the line between them is normal to both surfaces.
TEST(ClosestPoints, RefinedByNewtonDoNotDependOnTheStart) {
  const Shape shape;
  std::mt19937 random(7);
  const Net a = shape.bumpy(random, Vec3::Zero()), b = shape.bumpy(random, {0.4, 2.5, -0.9});
  const Patches first(shape.map, a), second(shape.map, b);
  ClosestPoints start = closest_points(ElementBoxes(first), ElementBoxes(second), 1e-6, 1e9);
  const auto refined = [&](double shift) {
    start.sites[0].s += shift, start.sites[1].t -= shift;
    return nearest_points(first[start.sites[0].element], second[start.sites[1].element], start);
  };
  const ClosestPoints found = refined(0), shifted = refined(1e-2);
  EXPECT_LT((found.first - shifted.first).norm() + (found.second - shifted.second).norm(), 1e-10);
  const Jet x = jet(first[found.sites[0].element], found.sites[0].s, found.sites[0].t);
  const Jet y = jet(second[found.sites[1].element], found.sites[1].s, found.sites[1].t);
  const Vec3 line = (found.second - found.first).normalized();
  EXPECT_LT(std::abs(line.dot(x.s)) + std::abs(line.dot(x.t)) + std::abs(line.dot(y.s)) + std::abs(line.dot(y.t)), 1e-9);
}

TEST(ClosestPoints, AreNotSoughtBeyondADistance) {
  const Shape shape;
  const Net other = shape.sphere.rowwise() + Eigen::RowVector3d(3, 0, 0);
  EXPECT_EQ(closest(shape, shape.sphere, other, 0.5).gap, 0.5);
}

TEST(ClosestPoints, OfSurfacesThatMeetHaveNoGap) {
  const Shape shape;
  const Net other = shape.sphere.rowwise() + Eigen::RowVector3d(1.5, 0.1, 0);
  EXPECT_LT(closest(shape, shape.sphere, other).gap, 1e-7);
}

/// A point in front of a thin body is behind the tangent planes of the elements on the far side of the body. In whatever order the elements are
/// visited, these elements must not give a film of width 0.
TEST(FilmWidths, InFrontOfAThinBody) {
  const Shape shape;
  const Net disc = shape.sphere.array().rowwise() * Eigen::RowVector3d(1, 1, 0.15).array();
  const Patches own(shape.map, disc);
  for (const double height : {0.6, -0.6}) {
    const Patches other(shape.map, disc.rowwise() + Eigen::RowVector3d(0, 0, height));
    const Patches* const others[] = {&other};
    const std::vector<double> widths = film_widths(own, others, 0.8);
    EXPECT_NEAR(*std::ranges::min_element(widths), 0.3, 0.02) << height;  // distance of elements from their tangent planes
  }
}

/// A sphere on the axis of a tube: the film is within reach near the equator only.
TEST(FilmWidths, NextToTheWallOfATube) {
  const Shape shape;
  TubeOptions options;
  options.radius = 1.1;
  const TubeWall wall = tube_wall(outline(options), options, 7);
  const Patches sphere(shape.map, shape.sphere), around(BezierMap(wall.space), wall.net);
  const Patches* const others[] = {&around};
  const std::vector<double> widths = film_widths(sphere, others, 0.25);
  EXPECT_NEAR(*std::ranges::min_element(widths), 0.1, 3e-3);  // the sphere's fit, and the distance of elements from their tangent planes
  for (int e = 0; e < sphere.size(); ++e)
    if (position(sphere[e], 0.5, 0.5).tail<2>().norm() < 0.3) {
      EXPECT_EQ(widths[static_cast<std::size_t>(e)], std::numeric_limits<double>::infinity());
    }
}

}  // namespace
}  // namespace tanktread::surface
