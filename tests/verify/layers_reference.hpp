#pragma once
// Layer potentials by brute force, independent of the program's quadrature. Far elements use 12 x 12 Gauss points. Close elements are divided into
// four parts recursively towards the target. Elements that contain the target use polar rules of 20 x 32 points in the metric at the target.

#include <array>
#include <cmath>
#include <functional>
#include <tuple>
#include <utility>
#include <vector>

#include "base/types.hpp"
#include "quadrature/gauss.hpp"
#include "spline/space.hpp"
#include "stokes/kernels/kernels.hpp"

namespace tanktread::verify {

/// Quadrature point on the surface. `jacobian` includes the quadrature weight.
struct SurfacePoint {
  int element;
  double s, t;
  Vec3 x, normal;  ///< unit normal, out of the surface
  double jacobian;
};

/// Field on one element by its Bezier points, with values and tangents by de Casteljau's algorithm.
class Casteljau {
 public:
  Casteljau(const spline::Element& element, const Net& net) : n_(element.degree + 1) {
    Net own(element.points.size(), 3);
    for (std::size_t a = 0; a < element.points.size(); ++a) own.row(a) = net.row(element.points[a]);
    points_ = element.extraction->transpose() * own;
  }

  std::array<Vec3, 3> operator()(double s, double t) const {  // returns x, x_,s, x_,t
    Polygon rows, slopes, row;
    for (int j = 0; j < n_; ++j) {
      for (int i = 0; i < n_; ++i) row[i] = points_.row(n_ * j + i);
      std::tie(rows[j], slopes[j]) = along(row, s);
    }
    const auto [x, xt] = along(rows, t);
    return {x, along(slopes, t).first, xt};
  }

 private:
  using Polygon = std::array<Vec3, 8>;
  std::pair<Vec3, Vec3> along(Polygon p, double at) const {
    for (int n = n_ - 1; n > 1; --n)
      for (int i = 0; i < n; ++i) p[i] = (1 - at) * p[i] + at * p[i + 1];
    return {(1 - at) * p[0] + at * p[1], (n_ - 1) * (p[1] - p[0])};
  }
  int n_;
  Net points_;
};

class BruteForce {
 public:
  BruteForce(const spline::Space& space, const Net& x) {
    for (const spline::Element& e : space.elements) shapes_.emplace_back(e, x);
    const auto& rule = quadrature::tensor_gauss(12);
    for (int e = 0; e < static_cast<int>(shapes_.size()); ++e) {
      for (int q = 0; q < rule.size(); ++q) far_.push_back(at(e, rule.s[q], rule.t[q], rule.weights[q]));
      const auto [centre, a, b] = shapes_[e](0.5, 0.5);
      centre_.push_back(centre);
      size_.push_back(std::max(a.norm(), b.norm()));
    }
  }

  /// Returns the integral of integrand(point) dGamma for a target on the elements of `sites`, or off the surface if there are no sites.
  Vec3 integrate(const Vec3& target, const std::vector<spline::Site>& sites,
                 const std::function<Vec3(const SurfacePoint&)>& integrand) const {
    Vec3 sum = Vec3::Zero();
    const auto add = [&](const SurfacePoint& p) { sum += integrand(p) * p.jacobian; };
    const int n_far = static_cast<int>(far_.size() / shapes_.size());
    for (int e = 0; e < static_cast<int>(shapes_.size()); ++e) {
      const spline::Site* own = nullptr;
      for (const spline::Site& site : sites)
        if (site.element == e) own = &site;
      if (own) {
        polar(*own, add);
      } else if ((centre_[e] - target).norm() < 1.5 * size_[e]) {
        parts(e, target, 0.5, 0.5, 0.5, add);
      } else {
        for (int q = 0; q < n_far; ++q) add(far_[n_far * e + q]);
      }
    }
    return sum;
  }

  Vec3 point(const spline::Site& site) const { return shapes_[site.element](site.s, site.t)[0]; }
  SurfacePoint at(int e, double s, double t, double weight) const {
    const auto [x, a, b] = shapes_[e](s, t);
    const Vec3 n = a.cross(b);
    return {e, s, t, x, n.normalized(), weight * n.norm()};
  }

 private:
  /// Integrates over the square part of an element within `half` of (s, t); divides it if it is close to the target.
  template <class Add>
  void parts(int e, const Vec3& target, double s, double t, double half, const Add& add) const {
    const auto [x, a, b] = shapes_[e](s, t);
    if ((x - target).norm() < 1.5 * 2 * half * std::max(a.norm(), b.norm()) && half > 1e-7) {
      for (const double i : {-0.5, 0.5})
        for (const double j : {-0.5, 0.5}) parts(e, target, s + i * half, t + j * half, half / 2, add);
    } else {
      const auto& g = quadrature::tensor_gauss(12);
      for (int q = 0; q < g.size(); ++q)
        add(at(e, s + (2 * g.s[q] - 1) * half, t + (2 * g.t[q] - 1) * half, 4 * half * half * g.weights[q]));
    }
  }

  template <class Add>
  void whole(int e, const Add& add) const {
    const auto& g = quadrature::tensor_gauss(32);
    for (int q = 0; q < g.size(); ++q) add(at(e, g.s[q], g.t[q], g.weights[q]));
  }

  template <class Add>
  void polar(const spline::Site& site, const Add& add) const {
    const auto [x, a1, a2] = shapes_[site.element](site.s, site.t);
    if (!(a1.norm() > 1e-9 && a2.norm() > 1e-9)) return whole(site.element, add);  // at a pole the area element vanishes linearly with r
    const double corner[5][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
    const auto &radial = quadrature::gauss(20), &angular = quadrature::gauss(32);
    for (int k = 0; k < 4; ++k) {
      const double as = corner[k][0] - site.s, at_ = corner[k][1] - site.t, bs = corner[k + 1][0] - site.s, bt = corner[k + 1][1] - site.t;
      const double area = as * bt - at_ * bs;
      if (area < 1e-12) continue;
      const Vec3 a = as * a1 + at_ * a2, b = bs * a1 + bt * a2, side = (b - a).normalized();
      const double low = a.dot(side), high = b.dot(side), h = (a - low * side).norm();
      const double from = std::asinh(low / h), range = std::asinh(high / h) - from;
      for (int j = 0; j < angular.size(); ++j) {
        const double mu = from + range * angular.nodes[j], q = (h * std::sinh(mu) - low) / (high - low);
        const double weight = angular.weights[j] * range * h * std::cosh(mu) / (high - low) * area;
        for (int i = 0; i < radial.size(); ++i) {
          const double r = radial.nodes[i];
          add(at(site.element, site.s + r * (as + q * (bs - as)), site.t + r * (at_ + q * (bt - at_)), weight * radial.weights[i] * r));
        }
      }
    }
  }

  std::vector<Casteljau> shapes_;
  std::vector<SurfacePoint> far_;
  std::vector<Vec3> centre_;
  std::vector<double> size_;
};

}  // namespace tanktread::verify
