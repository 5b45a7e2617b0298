// Tests of the open ends of a tube: line integrals are compared with area integrals.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "quadrature/gauss.hpp"
#include "stokes/flow/cap.hpp"
#include "stokes/kernels/kernels.hpp"

namespace tanktread::stokes {
namespace {

using std::numbers::pi;
using surface::Vec2;

/// Returns a slightly non-convex section about (0.1, -0.2).
surface::Outline bean(int m = 24) {
  std::vector<double> knots;
  std::vector<Vec2> points;
  for (int k = 0; k <= m; ++k) {
    const double t = 2 * pi * k / m, r = 1 + 0.2 * std::cos(2 * t) + 0.1 * std::sin(3 * t);
    knots.push_back(t);
    if (k < m) points.emplace_back(0.1 + r * std::cos(t), -0.2 + r * std::sin(t));
  }
  return surface::Outline({surface::interpolate_closed(knots, points)});
}

surface::Outline circle(int m) {
  surface::TubeOptions options;
  options.radius = 1;
  return surface::outline(options).spline(m);
}

/// Returns int f(x) dS over the section, integrated along rays from its middle.
template <class F>
auto over_section(const surface::Outline& outline, double place, const F& f) {
  const auto& rule = quadrature::gauss(12);
  const Vec2 middle(0.1, -0.2);
  auto sum = decltype(f(Vec3()))(0 * f(Vec3(place, 5, 5)));
  const auto knots = outline.knots(0, 24);
  for (std::size_t e = 0; e + 1 < knots.size(); ++e)
    for (int i = 0; i < rule.size(); ++i)
      for (int j = 0; j < rule.size(); ++j) {
        const double h = knots[e + 1] - knots[e], r = rule.nodes[j];
        const surface::PlaneJet at = outline.at(0, knots[e] + h * rule.nodes[i]);
        const Vec2 ray = at.x - middle, x = middle + r * ray;
        sum += rule.weights[i] * rule.weights[j] * h * r * (ray[0] * at.d[1] - ray[1] * at.d[0]) * f(Vec3(place, x[0], x[1]));
      }
  return sum;
}

TEST(Cap, IsTheIntegralOfStokesletsOverTheSection) {
  const surface::Outline outline = bean();
  const Cap cap(outline, -2, 1e-12);
  const Vec3 targets[] = {Vec3(0, 0.3, 0.2), Vec3(-1.2, -0.8, 0.1), Vec3(1, 0.9, -0.1)};
  for (const Vec3& x0 : targets) {
    const Vec3 exact = over_section(outline, -2, [&](const Vec3& x) -> Vec3 { return stokeslet(x - x0).col(0) / (8 * pi); });
    EXPECT_LT((cap.integral(x0) - exact).norm() / exact.norm(), 1e-10);
    EXPECT_LT((cap.integral(Net(x0.transpose())).row(0).transpose() - exact).norm() / exact.norm(), 1e-10);
  }
}

TEST(Cap, IsBoundedAndContinuousAtItsRim) {
  const surface::Outline outline = bean();
  const Cap cap(outline, 0, 1e-12);
  for (const double u : {outline.knots(0, 24)[5], 1.234}) {
    const Vec2 p = outline.point(0, u);
    const Vec3 on = cap.integral(Vec3(0, p[0], p[1])), off = cap.integral(Vec3(1e-7, p[0], p[1]));
    EXPECT_TRUE(on.allFinite());
    EXPECT_LT((on - off).norm() / on.norm(), 1e-5);  // the difference behaves like h log h
  }
}

TEST(Cap, GivesTheFlowRateOfADoubleLayer) {
  const surface::Outline outline = bean();
  const Cap cap(outline, -2, 1e-12);
  const Vec3 y(0.2, 0.3, -0.1), v(0.7, -1.1, 0.4), n(0.5, 0.2, -0.9);
  const double exact =
      over_section(outline, -2, [&](const Vec3& x) { return (stresslet(y - x, n) * v)[0] / (8 * pi); });  // T_ijk v_j n_k, symmetric
  EXPECT_NEAR(cap.double_layer_flow(y, n).dot(v) / exact, 1, 1e-9);
}

TEST(Cap, CausesAFlowThroughItself) {
  // int int 1/|x - x'| dS dS' = 16 pi/3 on the unit disc.
  EXPECT_NEAR(Cap(circle(48), 0, 1e-9).own_flow(), 2. / 3, 2e-6);  // the spline's area accounts for 8e-7
  EXPECT_NEAR(Cap(circle(24), 0, 1e-9).own_flow(), 2. / 3, 2e-5);
}

}  // namespace
}  // namespace tanktread::stokes
