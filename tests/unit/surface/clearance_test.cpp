#include "surface/clearance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tests/outlines.hpp"
#include "tests/unit/surface/surfaces.hpp"

namespace tanktread::surface {
namespace {

/// Returns the smallest distance by brute force: on each element the best point of a grid, refined repeatedly about the best point so far.
double sampled(const Patches& surface, const Outline& outline) {
  double least = std::numeric_limits<double>::infinity();
  for (int e = 0; e < surface.size(); ++e) {
    double best = std::numeric_limits<double>::infinity(), s = 0.5, t = 0.5;
    const auto look = [&](double half, int n) {
      const double s0 = s, t0 = t;
      for (int k = 0; k < (2 * n + 1) * (2 * n + 1); ++k) {
        const double at_s = std::clamp(s0 + half * (k % (2 * n + 1) - n) / n, 0., 1.),
                     at_t = std::clamp(t0 + half * (k / (2 * n + 1) - n) / n, 0., 1.);
        const Vec3 x = position(surface[e], at_s, at_t);
        if (const double gap = outline.distance({x[1], x[2]}); gap < best) best = gap, s = at_s, t = at_t;
      }
    };
    look(0.5, 10);
    if (best > least + 0.01) continue;
    for (double half = 0.1; half > 1e-5; half /= 2) look(half, 2);
    least = std::min(least, best);
  }
  return least;
}

struct Scene {
  Net net;
  const CubeMesh& mesh;
  Outline outline;
};

/// Checks that the point found has the reported distance, that no sample is nearer and the nearest sample not farther, and the work.
void is_the_least(const Scene& scene, int most_pieces, double tolerance = 1e-7) {
  const Patches surface(BezierMap(scene.mesh.space), scene.net);
  const Clearance found = clearance(surface, scene.outline);
  EXPECT_NEAR(scene.outline.distance({found.x[1], found.x[2]}), found.gap, 1e-15);
  EXPECT_NEAR(found.gap, sampled(surface, scene.outline), tolerance);
  EXPECT_LT(found.pieces, most_pieces);
}

Outline square(double half) { return polygon({{-half, -half}, {half, -half}, {half, half}, {-half, half}}); }

TEST(Clearance, IsTheSmallestDistanceForAnySurface) {
  const CubeMesh mesh(3);
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const Net net = mesh.crumpled(0.2, seed);
    for (const Outline& outline : {ellipse(1.7, 1.6), square(1.8), ellipse(2.5, 1.7).spline(12)}) is_the_least({net, mesh, outline}, 300);
    is_the_least({0.35 * net, mesh, trefoil(24)}, 300);
  }
}

TEST(Clearance, NeedsLittleWorkForEqualGaps) {
  const CubeMesh mesh(6);
  const Net sphere = 0.6 * mesh.sphere();
  is_the_least({sphere, mesh, ellipse(1, 1)}, 800);              // minima on a circle
  is_the_least({sphere, mesh, ellipse(1, 1).spline(24)}, 1500);  // minima on a circle that differ by 1e-6
  is_the_least({sphere, mesh, square(1)}, 800);                  // four minima
  is_the_least({sphere, mesh, trefoil(48)}, 800);                // three minima, where the wall is concave
  is_the_least({sphere, mesh, ellipse(1.2, 0.9)}, 800);          // two minima
  is_the_least({mesh.ellipsoid({1.5, 1.2, 0.8}), mesh, ellipse(1.3, 0.9)}, 3000);  // four minima in a gap of almost constant width
}

TEST(Clearance, IsNegativeOutside) {
  const CubeMesh mesh(3);
  const Net net = mesh.ellipsoid({1.0, 1.2, 0.7}, {20, 10, 5});
  is_the_least({net, mesh, ellipse(1.1, 1.0)}, 600, 1e-3);
  is_the_least({net, mesh, trefoil(24)}, 600, 1e-3);
}

}  // namespace
}  // namespace tanktread::surface
