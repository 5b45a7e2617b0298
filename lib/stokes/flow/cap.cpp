#include "stokes/flow/cap.hpp"

#include <algorithm>
#include <cmath>
#include <variant>

#include "quadrature/ellipse.hpp"
#include "quadrature/gauss.hpp"
#include "stokes/kernels/cap_kernel.hpp"
#include "stokes/kernels/kernels.hpp"

namespace tanktread::stokes {
namespace {

using surface::Vec2;

constexpr int close_order = 16;

/// At points closer than this to the plane of the cap, the integral is adaptive. Unit: half the length of the longest curve segment of the outline.
constexpr double close_by = 4;

std::vector<double> breaks(const surface::Outline& outline, int side) {
  if (const auto* curve = std::get_if<surface::CubicCurve>(&outline.side(side))) return curve->breaks;
  return outline.knots(side, 32);
}

/// Returns the outward normal of the outline times dl/du, l the arc length and u the parameter.
Vec2 weighted_normal(const surface::PlaneJet& at) { return {at.d[1], -at.d[0]}; }

/// Returns the integrands of (2.13), rho.nu / r and -h nu / r (symbols: see Cap), per unit of the curve parameter u. p: position in the plane.
Vec3 integrand(const surface::PlaneJet& at, const Vec2& p, double h) {
  const Vec2 rho = at.x - p, nu = weighted_normal(at);
  const double r = std::sqrt(rho.squaredNorm() + h * h);
  if (r == 0) return Vec3::Zero();
  return Vec3(rho.dot(nu), -h * nu[0], -h * nu[1]) / r;
}

/// Returns the integrand of own_flow() per unit of the curve parameter u: the distance from p to the curve times the normal of the curve.
Vec3 distance_times_normal(const surface::PlaneJet& at, const Vec2& p, double) {
  const Vec2 nu = (at.x - p).norm() * weighted_normal(at);
  return {0, nu[0], nu[1]};
}

/// Returns the integral of f over the part begin <= u <= end of one side of the outline, for a point with the projection p onto the plane and with h
/// as in Cap. Bisects the part until the chord of each interval is no longer than its distance from the point, or no longer than `smallest`.
template <class Integrand>
Vec3 stretch(const Integrand& f, const surface::Outline& outline, int side, double begin, double end, const Vec2& p, double h,
             double smallest) {
  const Vec2 a = outline.point(side, begin), b = outline.point(side, end), chord = b - a;
  const double along = std::clamp((p - a).dot(chord) / chord.squaredNorm(), 0., 1.);
  const double distance = std::hypot((a + along * chord - p).norm(), h), length = chord.norm();
  if (distance < length && length > smallest) {
    const double middle = (begin + end) / 2;
    return stretch(f, outline, side, begin, middle, p, h, smallest) + stretch(f, outline, side, middle, end, p, h, smallest);
  }
  const quadrature::GaussRule& rule = quadrature::gauss(close_order);
  Vec3 sum = Vec3::Zero();
  for (int q = 0; q < rule.size(); ++q)
    sum += rule.weights[q] * (end - begin) * f(outline.at(side, begin + rule.nodes[q] * (end - begin)), p, h);
  return sum;
}

template <class Integrand>
Vec3 around(const Integrand& f, const surface::Outline& outline, const Vec2& p, double h, double smallest) {
  Vec3 sum = Vec3::Zero();
  for (int k = 0; k < outline.n_sides(); ++k) {
    const std::vector<double> u = breaks(outline, k);
    for (std::size_t e = 0; e + 1 < u.size(); ++e) sum += stretch(f, outline, k, u[e], u[e + 1], p, h, smallest);
  }
  return sum;
}

}  // namespace

Cap::Cap(const surface::Outline& outline, double place, double tolerance) : outline_(outline), place_(place) {
  for (int k = 0; k < outline.n_sides(); ++k) {
    const std::vector<double> u = breaks(outline, k);
    for (std::size_t e = 0; e + 1 < u.size(); ++e)
      reach_ = std::max(reach_, (outline.point(k, u[e + 1]) - outline.point(k, u[e])).norm() / 2);
  }
  for (const double times : {close_by, 2 * close_by, 4 * close_by})
    rules_.push_back({times * reach_, nodes(std::max(3, 1 + quadrature::order_for(tolerance, quadrature::ellipse(0, times))))});
}

Cap::Nodes Cap::nodes(int order) const {
  const quadrature::GaussRule& rule = quadrature::gauss(order);
  Nodes all;
  for (int k = 0; k < outline_.n_sides(); ++k) {
    const std::vector<double> u = breaks(outline_, k);
    for (std::size_t e = 0; e + 1 < u.size(); ++e)
      for (int q = 0; q < rule.size(); ++q) {
        const surface::PlaneJet at = outline_.at(k, u[e] + rule.nodes[q] * (u[e + 1] - u[e]));
        const Vec2 normal = rule.weights[q] * (u[e + 1] - u[e]) * weighted_normal(at);
        all.y.push_back(at.x[0]), all.z.push_back(at.x[1]), all.ny.push_back(normal[0]), all.nz.push_back(normal[1]);
      }
  }
  return all;
}

const Cap::Nodes& Cap::nodes_for(double distance) const {
  std::size_t k = rules_.size() - 1;
  while (k > 0 && rules_[k].first > distance) --k;
  return rules_[k].second;
}

Vec3 Cap::integral(const Vec3& x0) const {
  const Vec2 p(x0[1], x0[2]);
  const double h = place_ - x0[0];
  return over_8_pi * around(integrand, outline_, p, h, 1e-10 * reach_);
}

Net Cap::integral(const Net& x) const {
  Net c(x.rows(), 3);
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const double h = place_ - x(i, 0), y = x(i, 1), z = x(i, 2);
    if (std::abs(h) < rules_[0].first) {
      c.row(i) = integral(Vec3(x.row(i))).transpose();
      continue;
    }
    const Nodes& n = nodes_for(std::abs(h));
    const CapSums sums = cap_sums(static_cast<int>(n.y.size()), n.y.data(), n.z.data(), n.ny.data(), n.nz.data(), h, y, z);
    c.row(i) << over_8_pi * sums.flux, -over_8_pi * h * sums.normal_y, -over_8_pi * h * sums.normal_z;
  }
  return c;
}

/// Returns 6 n_k M_jk/(8 pi) with M_jk = int h s_j s_k / s^5 dS and s = x - y. By the divergence theorem in the plane of the cap,
///   M_1a = -h^2/3 oint nu_a / s^3,   M_ab = -h/3 oint rho_a nu_b / s^3 + delta_ab W/3,   M_11 = W - M_22 - M_33.
/// Here h = s_1, rho = (s_2, s_3), nu is the outward normal of the outline in the plane, and a and b are 2 or 3. W is the solid angle of the cap,
/// sign(h) oint rho.nu / (s (s + |h|)).
Vec3 Cap::double_layer_flow(const Vec3& y, const Vec3& n) const {
  const double h = place_ - y[0];
  const Nodes& nodes = nodes_for(std::abs(h));
  Mat3 m = Mat3::Zero();
  double angle = 0;
  for (std::size_t k = 0; k < nodes.y.size(); ++k) {
    const Vec2 rho(nodes.y[k] - y[1], nodes.z[k] - y[2]), nu(nodes.ny[k], nodes.nz[k]);
    const double s = std::sqrt(rho.squaredNorm() + h * h), cube = 1 / (s * s * s);
    angle += std::copysign(1., h) * rho.dot(nu) / (s * (s + std::abs(h)));
    m.bottomRightCorner<2, 2>() -= h / 3 * cube * rho * nu.transpose();
    m.block<1, 2>(0, 1) -= h * h / 3 * cube * nu.transpose();
  }
  m.bottomRightCorner<2, 2>() += angle / 3 * Eigen::Matrix2d::Identity();
  m.block<2, 1>(1, 0) = m.block<1, 2>(0, 1).transpose();
  m(0, 0) = angle - m(1, 1) - m(2, 2);
  return 6 * over_8_pi * (m * n);
}

/// Computes int int G_11/(8 pi) dS dS' over the cap. In the plane of the cap, G_11 = 1/|x - x'|, and the integral of G_11 is - oint oint |x - x'|
/// nu.nu' dl dl'.
double Cap::own_flow() const {
  const Nodes n = nodes(6);
  double sum = 0;
  for (std::size_t k = 0; k < n.y.size(); ++k)
    sum -= around(distance_times_normal, outline_, {n.y[k], n.z[k]}, 0, 1e-4 * reach_).dot(Vec3(0, n.ny[k], n.nz[k]));
  return over_8_pi * sum;
}

}  // namespace tanktread::stokes
