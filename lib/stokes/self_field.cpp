#include "stokes/self_field.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "spline/bernstein.hpp"

namespace tanktread::stokes {
namespace {

/// Radial points for a tolerance. The integrand is smooth along a ray; measured on the cube mesh, n = 3 and up (tests/verify/layers.cpp).
int radial_points(double tolerance) { return std::max(4, static_cast<int>(std::ceil(-std::log10(tolerance))) - 1); }

Vec3 product(const double* bs, const double* bt, int n, const double* bezier) {
  Vec3 sum = Vec3::Zero();
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      for (int c = 0; c < 3; ++c) sum[c] += bs[i] * bt[j] * bezier[n * n * c + n * j + i];
  return sum;
}

}  // namespace

SelfField::SelfField(const spline::Space& space, const quadrature::Options& options)
    : options_(options), radial_(radial_points(options.tolerance)), first_{0} {
  for (const auto& sites : space.collocation) {
    for (const spline::Site& site : sites) {
      const int degree = space.elements[site.element].degree, n = degree + 1;
      SelfPair pair;
      pair.panel = site.element, pair.s = site.s, pair.t = site.t;
      pair.bernstein.resize(static_cast<std::size_t>(4) * n);
      double* b = pair.bernstein.data();
      spline::bernstein(degree, site.s, b, b + 2 * n, nullptr);
      spline::bernstein(degree, site.t, b + n, b + 3 * n, nullptr);
      pairs_.push_back(std::move(pair));
    }
    first_.push_back(pairs_.size());
  }
}

const PointTable& SelfField::rule(SelfPair& pair, const Panels& panels, const std::vector<double>& bezier) {
  const int degree = panels[pair.panel].table->degree, n = degree + 1;
  quadrature::Shear shear;
  if (options_.rule != "fixed") {
    const double *b = pair.bernstein.data(), *points = &bezier[panels[pair.panel].first_bezier];
    const Vec3 a1 = product(b + 2 * n, b + n, n, points), a2 = product(b, b + 3 * n, n, points);
    shear = quadrature::shear(a1.dot(a1), a1.dot(a2), a2.dot(a2));
  }
  if (!pair.table || shear != pair.shear) {
    pair.shear = shear;
    pair.table = &made(pair, degree, shear);
    pair.weights.clear();
  }
  return *pair.table;
}

const PointTable& SelfField::made(const SelfPair& pair, int degree, quadrature::Shear shear) {
  auto& table = tables_[{degree, pair.s, pair.t, shear}];
  if (!table) {
    table = std::make_unique<PointTable>();
    tabulate(options_.rule == "fixed" ? quadrature::lachat_watson(pair.s, pair.t, options_.points)
                                      : quadrature::polar(pair.s, pair.t, shear, radial_, options_.tolerance),
             degree, *table);
  }
  return *table;
}

void SelfField::forget_weights() {
  for (SelfPair& pair : pairs_) pair.weights.clear();
}

Vec3 SelfField::value(int i, const Panels& panels, const std::vector<double>& bezier) const {
  const SelfPair& pair = pairs_[first_[i]];
  const int n = panels[pair.panel].table->degree + 1;
  const double* b = pair.bernstein.data();
  return product(b, b + n, n, &bezier[panels[pair.panel].first_bezier]);
}

std::pair<Vec3, Vec3> SelfField::tangents(int i, const Panels& panels, const std::vector<double>& bezier) const {
  const SelfPair& pair = pairs_[first_[i]];
  const int n = panels[pair.panel].table->degree + 1;
  const double *b = pair.bernstein.data(), *points = &bezier[panels[pair.panel].first_bezier];
  return {product(b + 2 * n, b + n, n, points), product(b, b + 3 * n, n, points)};
}

std::pair<int, Eigen::VectorXd> SelfField::basis(int i, const Panels& panels) const {
  const SelfPair& pair = pairs_[first_[i]];
  const Panel& panel = panels[pair.panel];
  const int n = panel.table->degree + 1, n_b = n * n;
  Eigen::VectorXd values = Eigen::VectorXd::Zero(panel.functions);
  const double* extraction = panels.extraction(pair.panel);
  for (int a = 0; a < panel.functions; ++a)
    for (int b = 0; b < n_b; ++b) values[a] += extraction[n_b * a + b] * pair.bernstein[b % n] * pair.bernstein[n + b / n];
  return {pair.panel, values};
}

}  // namespace tanktread::stokes
