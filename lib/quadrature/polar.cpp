#include "quadrature/polar.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "quadrature/ellipse.hpp"
#include "quadrature/gauss.hpp"

namespace tanktread::quadrature {
namespace {

using Vec2 = Eigen::Vector2d;

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

Shear Shear::binned() const {
  constexpr double step = std::numbers::pi / 12;
  const double log2 = std::clamp(std::round(2 * std::log2(ratio)), -12., 12.);
  return {std::exp2(log2 / 2), step * std::clamp(std::round(angle / step), 2., 10.)};
}

Rule polar(double s, double t, const Shear& shear, int radial, double tolerance) {
  Eigen::Matrix2d metric;
  metric << 1, shear.ratio * std::cos(shear.angle), 0, shear.ratio * std::sin(shear.angle);
  const GaussRule& along = gauss(radial);
  Rule rule;
  each_triangle(s, t, [&](const Vec2& a, const Vec2& b) {
    const Vec2 ma = metric * a, mb = metric * b, side = (mb - ma).normalized();
    const double tau_a = ma.dot(side), tau_b = mb.dot(side), h = cross(ma, side);
    const double mu_a = std::asinh(tau_a / h), range = std::asinh(tau_b / h) - mu_a;
    const double rho = ellipse(0, std::numbers::pi / range);
    const GaussRule& around = gauss(1 + order_for(tolerance, rho));
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
