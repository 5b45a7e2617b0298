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

bool SelfField::choose(SelfPair& pair, int degree, const double* bezier) {
  quadrature::Shear shear;
  if (options_.rule != "fixed") {
    const int n = degree + 1;
    const double* b = pair.bernstein.data();
    const Vec3 a1 = product(b + 2 * n, b + n, n, bezier), a2 = product(b, b + 3 * n, n, bezier);
    shear = quadrature::shear(a1.dot(a1), a1.dot(a2), a2.dot(a2));
  }
  if (pair.table && shear == pair.shear) return false;
  pair.shear = shear;
  pair.table = &made(pair, degree, shear);
  return true;
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

Vec3 SelfField::point(int i, const Panels& panels, const std::vector<double>& bezier) const {
  const SelfPair& pair = pairs_[first_[i]];
  const int n = panels[pair.panel].table->degree + 1;
  return product(pair.bernstein.data(), pair.bernstein.data() + n, n, &bezier[panels[pair.panel].first_bezier]);
}

}  // namespace tanktread::stokes
