#include "surface/metrics.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "spline/refinement.hpp"
#include "spline/transfer.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"
#include "surfaces.hpp"

namespace tanktread::surface {
namespace {

TEST(Metrics, MidLinesOfASphereMeasureItsElementsAndHaveNoCurvatureVariation) {
  const int n = 12;
  const CubeMesh cube(n);
  const Net net = cube.sphere();
  const auto metrics = element_metrics(cube.mesh, cube.space, net, {});
  ASSERT_EQ(static_cast<int>(metrics.size()), 6 * n * n);
  double sum = 0, largest = 0;
  for (const ElementMetrics& m : metrics) {
    for (const MidLine& line : m.along) {
      sum += line.length;
      largest = std::max(largest, line.curvature * line.length);
    }
  }
  // An element has the area 4 pi/(6 n^2), so its mean mid-line is slightly shorter than sqrt(4 pi/6)/n, the side of a square.
  EXPECT_NEAR(sum / (12 * n * n) * n, std::sqrt(4 * 3.14159265 / 6), 0.05);
  EXPECT_LT(largest, 0.05);  // chi = 1 everywhere up to the error of the fit at the extraordinary points
}

TEST(Metrics, ALinearFieldVariesInProportionToTheLengthOfMidLines) {
  // phi = x itself: |phi(end) - phi(start)| / L is the ratio of chord to arc, which is one up to the curvature of the element.
  const CubeMesh cube(12);
  const Net net = cube.sphere();
  const auto metrics = element_metrics(cube.mesh, cube.space, net, {field_of_net(cube.space, net), field_of_net(cube.space, net)});
  for (const ElementMetrics& m : metrics) {
    for (const MidLine& line : m.along) {
      // sin(L/2)/(L/2) = 1 - L^2/24 for a great circle of radius one; the lines at the cube's corners are bent a little more.
      EXPECT_LE(line.velocity, 1 - line.length * line.length / 24 + 1e-4);
      EXPECT_GE(line.velocity, 0.99);
      EXPECT_EQ(line.traction, line.velocity);
    }
  }
}

TEST(Metrics, MeridiansOfAPolarSphereAreHalfCirclesAndPolesHaveNoMetric) {
  const spline::TMesh mesh = spline::polar(12, 8, 1);
  const spline::Space space = spline::space(mesh, spline::PoleRule::plain);
  const Net net = unit_sphere({12, 8, spline::PoleRule::plain}, space);
  const auto metrics = element_metrics(mesh, space, net, {per_current_area(space, net, net, net), {}});
  for (int k = 0; k < 12; ++k) {
    double meridian = 0;
    for (int row = 0; row < 8; ++row) {
      const ElementMetrics& m = metrics[static_cast<std::size_t>(12 * row + k)];
      meridian += m.along[1].length;
      EXPECT_GT(m.along[0].length, 0);
      EXPECT_EQ(m.along[1].traction == 0, row == 0 || row == 7);
    }
    EXPECT_NEAR(meridian, 3.14159265, 1e-3);
  }
}

TEST(Metrics, AStretchedSphereHasTheAspectRatioOfTheStretch) {
  const CubeMesh cube(6);
  const Net net = cube.ellipsoid({3, 1, 1});
  double largest = 0;
  for (const ElementMetrics& m : element_metrics(cube.mesh, cube.space, net, {})) {
    largest = std::max({largest, m.aspect_ratio(0), m.aspect_ratio(1)});
    EXPECT_NEAR(m.aspect_ratio(0) * m.aspect_ratio(1), 1, 1e-14);
  }
  EXPECT_GT(largest, 2.7);
  EXPECT_LT(largest, 3.6);
}

TEST(Metrics, TractionIsPerCurrentArea) {
  // A uniform load per reference area on a sphere inflated to twice its radius is a quarter of it per current area, everywhere.
  const CubeMesh cube(4);
  const Net rest = cube.sphere(), net = 2 * rest;
  const Net load = Net::Ones(cube.space.n_points, 3);
  const FieldAt traction = per_current_area(cube.space, rest, net, load);
  for (int e = 0; e < 10; ++e) EXPECT_LT((traction({e, 0.2, 0.7}) - Vec3::Constant(0.25)).norm(), 1e-13);
}

TEST(Metrics, DividingAnElementHalvesItsMidLineAndKeepsTheOthers) {
  // Refinement is exact, so the metrics of unchanged elements stay the same, although T-junctions now divide Bezier elements.
  spline::TMesh mesh = spline::cube(8, 2);
  const auto rule = spline::ExtraordinaryRule::catmull_clark;
  const spline::Space coarse = spline::space(mesh, rule);
  const LeastSquaresFit fit(coarse);
  const Net net = unit_sphere(mesh, fit);
  const auto before = element_metrics(mesh, coarse, net, {field_of_net(coarse, net), {}});
  const auto tiles_before = spline::elements(mesh).tiles;

  int middle = 0;
  for (std::size_t k = 0; k < tiles_before.size(); ++k) {
    const int units = mesh.lattice->units;
    if (tiles_before[k].x == units / 2 && tiles_before[k].y == units / 2) middle = static_cast<int>(k);
  }
  const spline::Refinement refined = spline::refine(mesh, {{middle, true, false}});
  const spline::Space fine = spline::space(refined.mesh, rule);
  const Net fine_net = spline::transfer(coarse, fine)(net).net;
  const auto after = element_metrics(refined.mesh, fine, fine_net, {field_of_net(fine, fine_net), {}});
  const auto tiles_after = spline::elements(refined.mesh).tiles;
  ASSERT_GT(tiles_after.size(), tiles_before.size());

  int unchanged = 0, halves = 0;
  for (std::size_t k = 0; k < tiles_after.size(); ++k) {
    for (std::size_t j = 0; j < tiles_before.size(); ++j) {
      const spline::Rectangle &a = tiles_after[k], &b = tiles_before[j];
      if (a.face != b.face || a.y != b.y || a.height != b.height) continue;
      if (a.x == b.x && a.width == b.width) {
        ++unchanged;
        for (int alpha = 0; alpha < 2; ++alpha) {
          EXPECT_NEAR(after[k].along[alpha].length, before[j].along[alpha].length, 1e-12);
          EXPECT_NEAR(after[k].along[alpha].traction, before[j].along[alpha].traction, 1e-10);
        }
      } else if (static_cast<int>(j) == middle && a.width * 2 == b.width && a.x >= b.x && a.x < b.x + b.width) {
        ++halves;
        EXPECT_NEAR(after[k].along[0].length, before[j].along[0].length / 2, 0.02 * before[j].along[0].length);
        EXPECT_NEAR(after[k].along[1].length, before[j].along[1].length, 0.02 * before[j].along[1].length);
      }
    }
  }
  EXPECT_EQ(halves, 2);
  EXPECT_GE(unchanged, static_cast<int>(tiles_before.size()) - 12);
}

}  // namespace
}  // namespace tanktread::surface
