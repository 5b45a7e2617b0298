#include "quadrature/polar.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <numbers>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "quadrature/ellipse.hpp"
#include "quadrature/gauss.hpp"

namespace tanktread::quadrature {
namespace {

using Vec2 = Eigen::Vector2d;

constexpr double step = std::numbers::pi / 12;
constexpr int max_order = 80;

/// Rounds a number of Gauss points up to an even number, or above 16 to a multiple of four, so that few different rules are needed.
int rounded_up(int order) { return order > 16 ? (order + 3) / 4 * 4 : (order + 1) / 2 * 2; }

/// Calls use(k, A, B) for every side k of the unit square that does not contain the point (s, t). A and B are the ends of the side relative to (s,
/// t).
template <class Use>
void each_triangle(double s, double t, const Use& use) {
  const Vec2 apex(s, t);
  const Vec2 corner[4] = {Vec2(0, 0), Vec2(1, 0), Vec2(1, 1), Vec2(0, 1)};
  for (int k = 0; k < 4; ++k) {
    const Vec2 a = corner[k] - apex, b = corner[(k + 1) % 4] - apex;
    if (cross(a, b) > 1e-12) use(k, a, b);
  }
}

/// Returns the parameter rho of the Bernstein ellipse of 1 / |a + r b| as a function of r in [0, 1]. The function is singular at the complex r =
/// (-a.b +- i |a x b|) / b.b.
double rho_along_ray(const Vec3& a, const Vec3& b) {
  const double square = b.squaredNorm();
  if (!(square > 1e-12 * a.squaredNorm()) || !(a.squaredNorm() > 0)) return 1e6;
  return ellipse(-2 * a.dot(b) / square - 1, 2 * a.cross(b).norm() / square);
}

/// Side from A to B of a triangle whose apex is the target. A linear map takes the parameter plane to a plane in which the tangents x_,s and x_,t
/// keep their angle and their ratio of lengths. All lengths below are measured in that plane. h: distance of the side from the apex. tau_a, tau_b:
/// positions of A and B along the side, from the foot of the perpendicular. mu_a: angular coordinate mu of A, see polar(). range: length of the
/// interval of mu.
struct FarSide {
  double h, tau_a, tau_b, mu_a, range;

  FarSide(MetricBin bin, const Vec2& a, const Vec2& b) {
    Eigen::Matrix2d metric;
    metric << 1, bin.ratio() * std::cos(bin.angle()), 0, bin.ratio() * std::sin(bin.angle());
    const Vec2 ma = metric * a, mb = metric * b, side = (mb - ma).normalized();
    tau_a = ma.dot(side), tau_b = mb.dot(side), h = cross(ma, side);
    mu_a = std::asinh(tau_a / h), range = std::asinh(tau_b / h) - mu_a;
  }

  int order(double tolerance, double rho) const { return 1 + order_for(std::pow(tolerance, 1.25) * std::exp(-range / 2), rho); }

  /// Returns the parameter rho of the Bernstein ellipse of the integrand as a function of the angular coordinate mu, for a side from a to b relative
  /// to the target. With c = b - a, the distance |a + q c| from the target vanishes at the complex q = (-a.c +- i |a x c|) / c.c.
  double rho(const Vec3& a, const Vec3& b) const {
    const Vec3 c = b - a;
    if (!(c.squaredNorm() > 1e-12 * a.squaredNorm())) return 1e6;
    const std::complex<double> q(-a.dot(c) / c.squaredNorm(), a.cross(c).norm() / c.squaredNorm());
    const std::complex<double> mu = std::asinh((tau_a + q * (tau_b - tau_a)) / h), z = 2. * (mu - mu_a) / range - 1.;
    return ellipse(z.real(), z.imag());
  }
};

}  // namespace

double MetricBin::ratio() const { return std::exp2(0.5 * doublings); }

double MetricBin::angle() const { return steps * step; }

MetricBin metric_bin(double g_ss, double g_st, double g_tt) {
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

PolarOrders polar_orders(double s, double t, MetricBin bin, int radial, double tolerance) {
  PolarOrders orders{radial, {}};
  each_triangle(s, t, [&](int k, const Vec2& a, const Vec2& b) {
    const FarSide side(bin, a, b);
    orders.angular[k] = side.order(tolerance, ellipse(0, std::numbers::pi / side.range));
  });
  return orders;
}

PolarOrders polar_orders(double s, double t, MetricBin bin, int radial, double tolerance, const std::array<Vec3, 4>& corner,
                         const std::array<Vec3, 4>& affine) {
  PolarOrders orders = polar_orders(s, t, bin, radial, tolerance);
  each_triangle(s, t, [&](int k, const Vec2& a, const Vec2& b) {
    const FarSide side(bin, a, b);
    orders.angular[k] = std::max(orders.angular[k], std::min(max_order, side.order(tolerance, side.rho(corner[k], corner[(k + 1) % 4]))));
  });
  // Along the ray to a corner, 0 <= r <= 1, the position relative to the target is approximated by x(r) = r affine + r^2 (corner - affine). The
  // integrand, of the order of 1/|x|, is singular at the complex r != 0 with x.x = 0.
  for (int k = 0; k < 4; ++k)
    orders.radial = std::max(orders.radial, std::min(max_order, 1 + order_for(tolerance, rho_along_ray(affine[k], corner[k] - affine[k]))));
  orders.radial = rounded_up(orders.radial);
  for (int& order : orders.angular) order = rounded_up(order);
  return orders;
}

Rule polar(double s, double t, MetricBin bin, const PolarOrders& orders) {
  const GaussRule& along = gauss(orders.radial);
  Rule rule;
  each_triangle(s, t, [&](int k, const Vec2& a, const Vec2& b) {
    const FarSide side(bin, a, b);
    const GaussRule& around = gauss(orders.angular[k]);
    for (int j = 0; j < around.size(); ++j) {
      const double mu = side.mu_a + side.range * around.nodes[j], length = side.tau_b - side.tau_a;
      const Vec2 ray = a + (side.h * std::sinh(mu) - side.tau_a) / length * (b - a);
      const double weight = around.weights[j] * side.range * side.h * std::cosh(mu) / length * cross(a, b);
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
  each_triangle(s, t, [&](int, const Vec2& a, const Vec2& b) {
    for (int j = 0; j < n; ++j) {
      const Vec2 ray = a + g.nodes[j] * (b - a);
      for (int i = 0; i < n; ++i)
        rule.add(s + g.nodes[i] * ray[0], t + g.nodes[i] * ray[1], g.weights[i] * g.weights[j] * g.nodes[i] * cross(a, b));
    }
  });
  return rule;
}

}  // namespace tanktread::quadrature
