#include "quadrature/graded.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "quadrature/ellipse.hpp"
#include "quadrature/gauss.hpp"
#include "spline/bernstein.hpp"

namespace tanktread::quadrature {
namespace {

struct Part {
  double s, t, width, height;
};

struct Bezier {
  std::span<const double> points;
  int degree;

  /// x, x_,s, x_,t
  std::array<Vec3, 3> at(double s, double t) const {
    constexpr int size = spline::most_polynomial_degree + 1;
    double bs[size], bt[size], ds[size], dt[size];
    spline::bernstein(degree, s, bs, ds, nullptr);
    spline::bernstein(degree, t, bt, dt, nullptr);
    const int n = degree + 1;
    std::array<Vec3, 3> value{Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const double* q = points.data() + j * n + i;
        const Vec3 p(q[0], q[n * n], q[2 * n * n]);
        value[0] += bs[i] * bt[j] * p, value[1] += ds[i] * bt[j] * p, value[2] += bs[i] * dt[j] * p;
      }
    return value;
  }

  /// Returns the planar approximation of a part of the element, and the largest distance between a corner of the part and the corresponding corner of
  /// the approximation.
  std::pair<Patch, double> patch(const Part& p) const {
    const auto [x, xs, xt] = at(p.s + p.width / 2, p.t + p.height / 2);
    const Patch flat{x, xs * p.width / 2, xt * p.height / 2};
    double bulge = 0;
    for (const int a : {-1, 1})
      for (const int b : {-1, 1}) {
        const Vec3 corner = at(p.s + (1 + a) * p.width / 2, p.t + (1 + b) * p.height / 2)[0];
        bulge = std::max(bulge, (corner - flat.centre - a * flat.u - b * flat.v).norm());
      }
    return {flat, bulge};
  }
};

void add(const Part& p, int n_s, int n_t, Rule& rule) {
  const GaussRule &gs = gauss(n_s), &gt = gauss(n_t);
  for (int j = 0; j < n_t; ++j)
    for (int i = 0; i < n_s; ++i)
      rule.add(p.s + p.width * gs.nodes[i], p.t + p.height * gt.nodes[j], p.width * p.height * gs.weights[i] * gt.weights[j]);
}

/// Smallest side of a part of an element, divided by the side of the element. Smaller parts are not bisected, because a target that would require
/// this is practically on the element.
constexpr double smallest = 1e-8;

/// A part of an element is bisected in both directions if the ratio of its squared side lengths is below this factor. Without this rule, round-off
/// would choose the direction for square parts, so the result would not respect the symmetry of the shape.
constexpr double square = 1.01;

/// Largest number of parts into which an element is divided; if more are needed, the integral is NaN. Even a target on the element needs only some
/// hundreds of parts.
constexpr int most_parts = 100'000;

}  // namespace

void graded(std::span<const double> bezier, int degree, const Vec3& target, const Demand& demand, Rule& rule) {
  const Bezier element{bezier, degree};
  const int largest = 1 + order_for(demand.tolerance, ellipse(0, 1));
  // Largest allowed bulge of a part (distance from its planar approximation), divided by the distance of the part from the target: first for the
  // kernel 1/r^2, then for 1/r. The values were found by tests/verify/layer_shapes.cpp.
  const double flat_enough = demand.steep > 0 ? 0.125 : 0.25;
  const double rho_smooth = std::pow(demand.tolerance, -0.5 / demand.smooth_order);
  std::vector<Part> parts{{0, 0, 1, 1}};
  for (int looked_at = 0; !parts.empty(); ++looked_at) {
    const Part p = parts.back();
    parts.pop_back();
    const auto [flat, bulge] = element.patch(p);
    const Sight seen = sight(flat, target);
    if (looked_at > most_parts || !std::isfinite(bulge) || !std::isfinite(seen.distance)) {
      rule.add(p.s, p.t, std::numeric_limits<double>::quiet_NaN());
      return;
    }
    const double error = demand.error(flat.area(), std::max(seen.distance, smallest * flat.u.norm()));
    const int n_s = std::max(order_for(error, seen.rho_u), order_for(demand.tolerance, rho_smooth / p.width));
    const int n_t = std::max(order_for(error, seen.rho_v), order_for(demand.tolerance, rho_smooth / p.height));
    const bool enough = std::max(n_s, n_t) <= largest && bulge <= flat_enough * seen.distance;
    if (enough || std::max(p.width, p.height) < smallest) {
      add(p, std::min(n_s, largest), std::min(n_t, largest), rule);
    } else {
      const double longer = flat.u.squaredNorm() / flat.v.squaredNorm();
      const int in_s = longer > 1 / square ? 2 : 1, in_t = longer < square ? 2 : 1;
      const double width = p.width / in_s, height = p.height / in_t;
      for (int j = in_t; j-- > 0;)
        for (int i = in_s; i-- > 0;) parts.push_back({p.s + i * width, p.t + j * height, width, height});
    }
  }
}

}  // namespace tanktread::quadrature
