#include "stokes/flow/duct_boundary.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>

#include "quadrature/gauss.hpp"
#include "tests/outlines.hpp"

namespace tanktread::stokes {
namespace duct_boundary_test {

using surface::Outline;
using surface::Vec2;

constexpr double pi = std::numbers::pi;

TEST(OutlineSpace, HasOneSiteAFunctionAndElementsThatEndAtTheOutlinesKnots) {
  const Outline smooth = ellipse(1, 0.5).spline(10), cornered = polygon({{0, 0}, {4, 0}, {0, 1}});
  EXPECT_EQ(OutlineSpace(smooth, 10).size(), 10);
  EXPECT_EQ(OutlineSpace(smooth, 20).elements().size(), 20u);
  EXPECT_EQ(OutlineSpace(smooth, 4).elements().size(), 10u) << "no fewer than the outline has";
  const OutlineSpace space(cornered, 20);
  EXPECT_EQ(space.size(), static_cast<int>(space.elements().size()) + 3 * 3) << "nothing shared at corners";
  std::vector<double> sum(static_cast<std::size_t>(space.size()));
  for (const OutlineElement& e : space.elements()) {
    EXPECT_LT((e.bernstein.colwise().sum().array() - 1).abs().maxCoeff(), 1e-14) << "partition of unity";
    EXPECT_LT(e.begin, e.end);
  }
  for (const OutlineSite& s : space.sites()) {
    const OutlineElement& e = space.elements()[static_cast<std::size_t>(s.element)];
    EXPECT_TRUE(e.side == s.side && e.begin <= s.t && s.t <= e.end);
    const double from_end = std::min(s.t, 1 - s.t);
    EXPECT_GT(from_end, 0) << "no site on a corner";
  }
}

TEST(OutlineSpace, DerivativesAreThoseOfThePositions) {
  const OutlineSpace space(polygon({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}), 24);
  for (int k = 0; k < 6; ++k)
    for (const double t : {0.05, 0.3, 0.6, 0.97}) {
      const double h = 1e-6;
      const Vec2 slope = (space.at(k, t + h).x - space.at(k, t - h).x) / (2 * h);
      EXPECT_LT((space.at(k, t).d - slope).norm(), 1e-8);  // h^2 and round-off/h
    }
}

TEST(CauchySums, GiveAnAnalyticFunctionAndItsDerivativeUpToTheCurve) {
  const Outline o = ellipse(1, 0.6);
  const auto& rule = quadrature::gauss(8);
  std::vector<double> x, y, dx, dy, f, g;
  const auto function = [](std::complex<double> z) { return z * z * z - std::exp(0.7 * z); };
  const auto slope = [](std::complex<double> z) { return 3. * z * z - 0.7 * std::exp(0.7 * z); };
  for (int e = 0; e < 24; ++e)
    for (int q = 0; q < rule.size(); ++q) {
      const auto j = o.at(0, 2 * pi * (e + rule.nodes[q]) / 24);
      const double w = 2 * pi * rule.weights[q] / 24;
      const auto value = function({j.x[0], j.x[1]});
      x.push_back(j.x[0]), y.push_back(j.x[1]), dx.push_back(w * j.d[0]), dy.push_back(w * j.d[1]);
      f.push_back(value.real()), g.push_back(value.imag());
    }
  const CauchyNodes nodes{static_cast<int>(x.size()), x.data(), y.data(), dx.data(), dy.data(), f.data(), g.data()};
  std::vector<double> px, py;
  for (const double depth : {0.4, 0.1, 1e-2, 1e-4, 1e-7})
    for (int i = 0; i < 11; ++i) {
      const Vec2 p = o.point(0, 0.57 * i) - depth * o.normal(0, 0.57 * i);
      px.push_back(p[0]), py.push_back(p[1]);
    }
  px.push_back(x[5]), py.push_back(y[5]);  // a point that coincides with a node
  std::vector<double> u(px.size()), u2(px.size()), u3(px.size()), alone(px.size());
  cauchy_sums(nodes, 1, static_cast<int>(px.size()), px.data(), py.data(), u.data(), u2.data(), u3.data());
  for (std::size_t i = 0; i < px.size(); ++i) {
    const std::complex<double> z(px[i], py[i]);
    EXPECT_NEAR(u[i], function(z).real(), 1e-12) << i;  // 8 Gauss points on elements of size 0.2: error below round-off
    if (i + 1 < px.size()) {                            // round-off divided by the distance to a node
      EXPECT_LT(std::hypot(u2[i] - slope(z).real(), u3[i] + slope(z).imag()), 1e-8) << i;
    }
    cauchy_sums(nodes, 1, 1, &px[i], &py[i], &alone[i], nullptr, nullptr);
    EXPECT_EQ(alone[i], u[i]) << "one point alone, as among many";
  }
}

TEST(BoundaryProfile, OfACircleIsExactOnTheExactCircleOfAnyRadius) {
  for (const double radius : {0.3, 1.0, 7.0}) {  // radius 1: without the constant kappa in (2.15) the matrix is singular
    const BoundaryProfile p(ellipse(radius, radius), 12);
    EXPECT_NEAR(p.flow_rate() / (pi * std::pow(radius, 4) / 8), 1, 1e-13);
  }
}

TEST(BoundaryProfile, DoesNotDependOnThePositionOfTheSection) {
  const std::vector<Vec2> corners{{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
  std::vector<Vec2> moved;
  for (const Vec2& c : corners) moved.push_back(0.5 * Vec2(-c[1], c[0]) + Vec2(4, -3));  // rotated by a right angle and scaled by a half
  const BoundaryProfile one(polygon(corners), 48), other(polygon(moved), 48);
  EXPECT_NEAR(other.flow_rate() * 16 / one.flow_rate(), 1, 1e-11);  // round-off of the matrix
  const Vec2 x(0.8, 0.7), z = 0.5 * Vec2(-x[1], x[0]) + Vec2(4, -3);
  double u, u2, u3, v, v2, v3;
  one.evaluate(1, &x[0], &x[1], &u, &u2, &u3);
  other.evaluate(1, &z[0], &z[1], &v, &v2, &v3);
  EXPECT_NEAR(4 * v, u, 1e-11);
  EXPECT_NEAR(2 * v2, -u3, 1e-10);
  EXPECT_NEAR(2 * v3, u2, 1e-10);
}

}  // namespace duct_boundary_test
}  // namespace tanktread::stokes
