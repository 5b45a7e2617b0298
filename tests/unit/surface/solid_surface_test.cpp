// Tests of the surfaces of plates and posts, and of periodic densities on these surfaces.

#include "surface/walls/solid_surface.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "surface/geometry.hpp"

namespace tanktread::surface {
namespace {

/// Returns the integrals over a surface of 1, the position and the square of the distance from `from`, by the midpoints of a fine grid.
std::array<double, 2> integrals(const SolidSurface& surface, const Vec3& from) {
  constexpr int n = 8;
  std::array<double, 2> sum{0, 0};
  for (int e = 0; e < static_cast<int>(surface.space.elements.size()); ++e)
    for (int i = 0; i < n * n; ++i) {
      const Point at = point(surface.space, surface.net, {e, (i % n + 0.5) / n, (i / n + 0.5) / n});
      const double area = at.jacobian / (n * n);
      sum[0] += area, sum[1] += area * (at.x - from).squaredNorm();
    }
  return sum;
}

/// Returns values of a density with random control values along a line of parameters, at both sides of the seam.
Net random_density(const SolidSurface& surface) {
  Net f(surface.n_points(), 3);
  for (Eigen::Index i = 0; i < f.size(); ++i) f.data()[i] = std::sin(12.9898 * static_cast<double>(i + 1));
  return surface.open_from_periodic * f;
}

TEST(SolidSurface, PlateIsOnePeriodOfAPlane) {
  const Vec3 first(3, 0, 0), second(0.5, 2, 0);
  const SolidSurface surface = plate(Vec3(0, 0, 1), first, second, {6, 5});
  EXPECT_EQ(surface.n_points(), 30);
  EXPECT_NEAR(integrals(surface, Vec3::Zero())[0], 6, 1e-12);
  for (const auto& sites : surface.sites) {
    const Point at = point(surface.space, surface.net, sites.front());
    EXPECT_NEAR(at.x[2], 1, 1e-14);
    EXPECT_NEAR((at.n - Vec3::UnitZ()).norm(), 0, 1e-13);
  }
}

TEST(SolidSurface, CylinderHasItsAreaAndIsRound) {
  const SolidSurface surface = cylinder(Vec3(1, 2, 3), Vec3(0, 2.5, 0), 0.7, 24, 6);
  EXPECT_EQ(surface.n_points(), 24 * 6);
  EXPECT_NEAR(integrals(surface, Vec3::Zero())[0], 2 * std::numbers::pi * 0.7 * 2.5, 2e-5);
  for (const auto& sites : surface.sites) {
    const Point at = point(surface.space, surface.net, sites.front());
    const Vec3 out(at.x[0] - 1, 0, at.x[2] - 3);
    EXPECT_NEAR(out.norm(), 0.7, 2e-5);
    EXPECT_GT(at.n.dot(out), 0.69);
  }
}

/// The density, its first and its second derivative continue across the seam: as many values at the ends of the period agree.
TEST(SolidSurface, DensitiesArePeriodic) {
  const SolidSurface surface = plate(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), {5, 7});
  const Net f = random_density(surface);
  const int m = 8, last = 5;  // elements along the second vector, of which the seam cuts one; index of the last row along the first one
  const double seam = 0.25, h = 1e-4;
  for (int k = 0; k < m; ++k) {
    const auto before = [&](double s) { return value(surface.space, f, {last * m + k, 1 - s / seam, 0.3}); };  // s: in elements from the seam
    const auto after = [&](double s) { return value(surface.space, f, {k, s / (1 - seam), 0.3}); };
    EXPECT_LT((before(0) - after(0)).norm(), 1e-12);
    const Vec3 slope_before = (4 * (before(0) - before(h)) - (before(0) - before(2 * h))) / (2 * h);
    const Vec3 slope_after = (4 * (after(h) - after(0)) - (after(2 * h) - after(0))) / (2 * h);
    EXPECT_LT((slope_before - slope_after).norm(), 1e-5);
  }
}

TEST(SolidSurface, ConstantsAreDensities) {
  const SolidSurface one = plate(Vec3::Zero(), Vec3::UnitX(), Vec3::UnitY(), {4, 6}), other = cylinder(Vec3(0, 0, 2), Vec3::UnitX(), 0.3, 8, 4);
  const SolidSurface surface = stacked({one, other});
  const Eigen::VectorXd ones = surface.open_from_periodic * Eigen::VectorXd::Ones(surface.n_points());
  EXPECT_LT((ones.array() - 1).abs().maxCoeff(), 1e-12);
  EXPECT_EQ(surface.n_points(), 24 + 32);
}

}  // namespace
}  // namespace tanktread::surface
