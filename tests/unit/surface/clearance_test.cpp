#include "surface/clearance.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/outlines.hpp"
#include "tests/unit/surface/surfaces.hpp"

namespace tanktread::surface {
namespace {

/// Smallest distance of n x n points an element.
double sampled(const Patches& surface, const Outline& outline, int n) {
  double least = 1e300;
  for (int e = 0; e < surface.size(); ++e)
    for (int k = 0; k < n * n; ++k) {
      const Vec3 x = place(surface[e], k % n / (n - 1.0), k / n / (n - 1.0));
      least = std::min(least, outline.distance({x[1], x[2]}));
    }
  return least;
}

/// No sample is nearer, and the nearest one is as far off as samples are apart.
void is_the_least(const Net& net, const CubeMesh& mesh, const Outline& outline) {
  const Patches surface(BezierMap(mesh.space), net);
  const Clearance found = clearance(surface, outline);
  const double samples = sampled(surface, outline, 21);
  EXPECT_LT(found.gap, samples + 1e-9);
  EXPECT_GT(found.gap, samples - 2e-2);
  EXPECT_NEAR(outline.distance({found.x[1], found.x[2]}), found.gap, 1e-15);
}

TEST(Clearance, IsTheLeastWhereverTheSurfaceComesNear) {
  const CubeMesh mesh(3);
  const Outline square = polygon({{-1.6, -1.6}, {1.6, -1.6}, {1.6, 1.6}, {-1.6, 1.6}});
  for (unsigned seed = 1; seed <= 2; ++seed)
    for (const Outline& outline : {ellipse(1.7, 1.6), square, trefoil(24)}) is_the_least(mesh.crumpled(0.2, seed), mesh, outline);
}

TEST(Clearance, IsNegativeOutside) {
  const CubeMesh mesh(3);
  is_the_least(mesh.ellipsoid({1.0, 1.2, 0.7}, {20, 10, 5}), mesh, ellipse(1.1, 1.0));
}

}  // namespace
}  // namespace tanktread::surface
