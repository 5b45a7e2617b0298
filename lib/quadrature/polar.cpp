#include "quadrature/polar.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "quadrature/ellipse.hpp"
#include "quadrature/gauss.hpp"

namespace tanktread::quadrature {
namespace {

using Vec2 = Eigen::Vector2d;

constexpr double step = std::numbers::pi / 12;

double cross(const Vec2& a, const Vec2& b) { return a[0] * b[1] - a[1] * b[0]; }

/// Calls use(A, B) with the ends, seen from (s, t), of every side of the square that does not hold (s, t).
template <class Use>
void each_triangle(double s, double t, const Use& use) {
  const Vec2 apex(s, t);
  const Vec2 corner[4] = {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
  for (int k = 0; k < 4; ++k) {
    const Vec2 a = corner[k] - apex, b = corner[(k + 1) % 4] - apex;
    if (cross(a, b) > 1e-12) use(a, b);
  }
}

}  // namespace

double Shear::ratio() const { return std::exp2(0.5 * doublings); }

double Shear::angle() const { return steps * step; }

Shear shear(double g_ss, double g_st, double g_tt) {
  static const auto borders = [] {
    std::array<double, 10> cosine;
    for (int k = 0; k < 10; ++k) cosine[k] = std::cos((k + 1.5) * step);
    return cosine;
  }();
  const double square = g_tt / g_ss, cosine = g_st / std::sqrt(g_ss * g_tt);
  if (!(square > 0 && std::isfinite(square) && std::isfinite(cosine))) return {};
  int steps = 1;
  for (const double border : borders) steps += cosine < border;
  return {std::clamp(std::ilogb(square * std::numbers::sqrt2), -24, 24), steps};
}

Rule polar(double s, double t, Shear shear, int radial, double tolerance) {
  Eigen::Matrix2d metric;
  metric << 1, shear.ratio() * std::cos(shear.angle()), 0, shear.ratio() * std::sin(shear.angle());
  const GaussRule& along = gauss(radial);
  Rule rule;
  each_triangle(s, t, [&](const Vec2& a, const Vec2& b) {
    const Vec2 ma = metric * a, mb = metric * b, side = (mb - ma).normalized();
    const double tau_a = ma.dot(side), tau_b = mb.dot(side), h = cross(ma, side);
    const double mu_a = std::asinh(tau_a / h), range = std::asinh(tau_b / h) - mu_a;
    const double rho = ellipse(0, std::numbers::pi / range);
    const GaussRule& around = gauss(1 + order_for(std::pow(tolerance, 1.25) * std::exp(-range / 2), rho));
    for (int j = 0; j < around.size(); ++j) {
      const double mu = mu_a + range * around.nodes[j];
      const Vec2 ray = a + (h * std::sinh(mu) - tau_a) / (tau_b - tau_a) * (b - a);
      const double weight = around.weights[j] * range * h * std::cosh(mu) / (tau_b - tau_a) * cross(a, b);
      for (int i = 0; i < along.size(); ++i) {
        const double r = along.nodes[i];
        rule.add(s + r * ray[0], t + r * ray[1], weight * along.weights[i] * r);
      }
    }
  });
  return rule;
}

Rule lachat_watson(double s, double t, int n) {
  const GaussRule& g = gauss(n);
  Rule rule;
  each_triangle(s, t, [&](const Vec2& a, const Vec2& b) {
    for (int j = 0; j < n; ++j) {
      const Vec2 ray = a + g.nodes[j] * (b - a);
      for (int i = 0; i < n; ++i)
        rule.add(s + g.nodes[i] * ray[0], t + g.nodes[i] * ray[1], g.weights[i] * g.weights[j] * g.nodes[i] * cross(a, b));
    }
  });
  return rule;
}

}  // namespace tanktread::quadrature
