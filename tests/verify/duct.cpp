// Flow through ducts by boundary elements, compared with exact solutions: orders of convergence, and accuracy up to the wall.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "stokes/flow/duct_boundary.hpp"
#include "tests/outlines.hpp"

namespace tanktread {
namespace {

using stokes::BoundaryProfile;
using stokes::DuctProfile;
using surface::Outline;
using surface::Vec2;

constexpr double pi = std::numbers::pi;

double ellipse_rate(double a, double b) { return pi * std::pow(a * b, 3) / (4 * (a * a + b * b)); }

/// Returns the relative error of the flow rate, with n elements for both outline and density.
double rate_error(const Outline& isogeometric, int n, double exact) { return BoundaryProfile(isogeometric, n).flow_rate() / exact - 1; }

TEST(DuctByBoundaryElements, HasAFlowRateOfOrderFour) {
  const auto check = [](const Outline& o, double exact) {
    const double coarse = rate_error(o.spline(48), 48, exact), fine = rate_error(o.spline(96), 96, exact);
    EXPECT_NEAR(std::log2(coarse / fine), 4, 0.1);
    EXPECT_LT(std::abs(fine), 2e-7);
  };
  check(ellipse(1, 1), ellipse_rate(1, 1));  // R = 1 is the degenerate scale of the logarithmic kernel
  check(ellipse(0.4, 0.4), ellipse_rate(0.4, 0.4));
  check(ellipse(1, 0.5), ellipse_rate(1, 0.5));
  const double trefoil_rate = 0.3089934973;  // ten digits, extrapolated from results of another program
  EXPECT_NEAR(std::log2(rate_error(trefoil(48), 48, trefoil_rate) / rate_error(trefoil(96), 96, trefoil_rate)), 4, 0.2);
}

TEST(DuctByBoundaryElements, GainsAnOrderWhereTheOutlineIsExact) {
  const Outline o = ellipse(1, 0.5);
  const double coarse = rate_error(o, 24, ellipse_rate(1, 0.5)), fine = rate_error(o, 48, ellipse_rate(1, 0.5));
  EXPECT_GT(std::log2(coarse / fine), 4.7);
  EXPECT_LT(std::abs(fine), 1e-8);
}

TEST(DuctByBoundaryElements, HasTheFlowRateOfSectionsWithCorners) {
  const double tolerance = 1e-7;  // a hundredth of the requirement; measured: 1.1e-8, 3e-9, 9e-9, 1e-7
  EXPECT_LT(std::abs(rate_error(polygon({{0, 0}, {1, 0}, {0.5, std::sqrt(0.75)}}), 96, std::sqrt(3) / 320)), tolerance);
  EXPECT_LT(std::abs(rate_error(polygon({{0, 0}, {1, 0}, {1, 1}, {0, 1}}), 96, stokes::rectangle_profile({1, 1})->flow_rate())), tolerance);
  EXPECT_LT(std::abs(rate_error(polygon({{0, 0}, {1, 0}, {1, 3}, {0, 3}}), 96, stokes::rectangle_profile({1, 3})->flow_rate())), tolerance);
  const Outline inward = polygon({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}});
  EXPECT_LT(std::abs(rate_error(inward, 96, BoundaryProfile(inward, 384).flow_rate())), 2 * tolerance)
      << "infinite shear rate at one corner";
}

/// Largest errors of u and of its gradient at the distance 1e-3 R_T from the wall, divided by the largest u and gradient.
struct NearWall {
  double velocity = 0, gradient = 0;
};

NearWall near_wall(const Outline& o, const DuctProfile& profile, const DuctProfile& exact) {
  NearWall error;
  double steepest = 0, top, none2, none3;
  const Vec2 c = o.centroid();
  exact.evaluate(1, &c[0], &c[1], &top, &none2, &none3);
  for (int k = 0; k < o.n_sides(); ++k)
    for (const double u : o.knots(k, 499)) {  // 499 is no multiple of the number of elements, so all positions between nodes occur
      const Vec2 x = o.point(k, u) - 1e-3 * o.radius() * o.normal(k, u);
      if (o.distance(x) < 0.99e-3 * o.radius()) continue;  // adjacent to a corner
      double a, a2, a3, b, b2, b3;
      profile.evaluate(1, &x[0], &x[1], &a, &a2, &a3);
      exact.evaluate(1, &x[0], &x[1], &b, &b2, &b3);
      error.velocity = std::max(error.velocity, std::abs(a - b) / top);
      error.gradient = std::max(error.gradient, std::hypot(a2 - b2, a3 - b3));
      steepest = std::max(steepest, std::hypot(b2, b3));
    }
  return {error.velocity, error.gradient / steepest};
}

TEST(DuctByBoundaryElements, KeepsItsAccuracyUpToTheWall) {
  const auto check = [](const Outline& o, const DuctProfile& exact) {
    const NearWall error = near_wall(o, BoundaryProfile(o, 96), exact);
    EXPECT_LT(error.velocity, 1e-6);
    EXPECT_LT(error.gradient, 1e-4);
  };
  check(ellipse(1, 1).spline(96), *stokes::ellipse_profile({1, 1}));  // measured: 9e-8, 2e-6
  check(ellipse(1, 0.5).spline(96), *stokes::ellipse_profile({1, 0.5}));
  check(ellipse(1, 0.5), *stokes::ellipse_profile({1, 0.5}));
  check(polygon({{-0.5, -1.5}, {0.5, -1.5}, {0.5, 1.5}, {-0.5, 1.5}}), *stokes::rectangle_profile({1, 3}));  // measured: 4e-8, 6e-6
  check(trefoil(96), BoundaryProfile(trefoil(96), 384));  // the reference uses the same spline, so its deviation from the trefoil does not count
}

}  // namespace
}  // namespace tanktread
