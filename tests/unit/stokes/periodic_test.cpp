// Tests of sums over lattices, compared with our own multipole solutions (lib/README.md, section on lattices) and with identities.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include "quadrature/gauss.hpp"
#include "stokes/kernels/far_kernel.hpp"
#include "stokes/kernels/kernels.hpp"
#include "stokes/medium/periodic_images.hpp"
#include "stokes/medium/periodic_sum.hpp"

namespace tanktread::stokes {
namespace periodic_test {

using Kind = PeriodicKernel::Kind;
using Six = Eigen::Matrix<double, 6, 1>;
constexpr double pi = std::numbers::pi;

Mat3 rows(const Vec3& a, const Vec3& b, const Vec3& c) {
  Mat3 columns;
  columns << a, b, c;
  return columns;
}

Mat3 general() { return rows({1, 0, 0}, {0.4, 1.3, 0}, {-0.2, 0.25, 0.8}); }

/// Returns all components of the sum over the lattice at r = x - x0: near images plus the rest.
std::vector<double> whole(Kind kind, const PeriodicCell& cell, const Vec3& r, int steps = 1, double across = 1) {
  Mat3 box = cell.vectors();
  for (int d = cell.n(); d < 3; ++d) box.col(d) *= across;
  const std::array<int, 3> near{steps, steps, steps};
  const Vec3 s = box.inverse() * r;
  std::vector<double> values = PeriodicKernel(kind, cell, box, near, 1e-13).values({std::vector{s[0]}, {s[1]}, {s[2]}});
  constexpr int pairs[6][2] = {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}, stresses[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
  for (const Vec3& image : cell.around(near)) {
    const Vec3 x = r + image;
    const Mat3 g = stokeslet(x);
    for (std::size_t c = 0; c < values.size(); ++c) {
      if (kind == Kind::stokeslet) {
        values[c] += g(pairs[c][0], pairs[c][1]);
        continue;
      }
      const auto& [j, k] = stresses[c % 6];
      values[c] += (j == k ? -6 : -12) * x[static_cast<int>(c / 6)] * x[j] * x[k] / std::pow(x.norm(), 5);
    }
  }
  return values;
}

Six stokeslet_at(const PeriodicCell& cell, const Vec3& r, int steps = 1, double across = 1) {
  return Eigen::Map<const Six>(whole(Kind::stokeslet, cell, r, steps, across).data());
}

Six six(double a, double b, double c, double d, double e, double f) { return (Six() << a, b, c, d, e, f).finished(); }

TEST(PeriodicKernel, StokesletsOfThreePeriodsHaveTheKnownValues) {
  const Vec3 far(0.1, 0.2, 0.3), near(0.05, -0.02, 0.01);
  const PeriodicCell cube(Mat3::Identity(), 3), any(general(), 3);
  const Six known[4] = {six(-0.7029562442847, 0.2967332825332, 0.4115157245489, 0.006777515630703, 0.8030045620774, 1.148218321646),
                        six(29.70521658821, -6.079469631202, 3.039738083231, 16.91388255839, -1.215904567578, 15.08654970939),
                        six(0.1637629575527, 0.2834570925626, 0.1288123218102, -0.3610353761513, 1.239355734911, 1.74120395653),
                        six(30.04794704118, -6.111751848756, 2.942552719864, 16.53236025336, -0.8901593233324, 15.64995685679)};
  for (const int steps : {1, 2}) {
    EXPECT_LT((stokeslet_at(cube, far, steps) - known[0]).norm(), 1e-11);
    EXPECT_LT((stokeslet_at(cube, near, steps) - known[1]).norm(), 1e-10);
    EXPECT_LT((stokeslet_at(any, far, steps) - known[2]).norm(), 1e-11);
    EXPECT_LT((stokeslet_at(any, near, steps) - known[3]).norm(), 1e-10);
  }
}

TEST(PeriodicKernel, StokesletsOfTwoPeriodsHaveKnownDifferences) {
  const PeriodicCell cell(Mat3::Identity(), 2);
  const Six known = six(-3.869674721424, 0.2847371220542, 0.4784096156009, -3.231353441273, 0.9221163516607, 0.9844550994578) -
                    six(-15.0757091142, 0.0002160606654125, 0.008003417215417, -15.08586387131, 0.004623662308219, 0.004342482468543);
  for (const int steps : {1, 2})
    EXPECT_LT((stokeslet_at(cell, {0.1, 0.2, 0.3}, steps, 1.3) - stokeslet_at(cell, {0.3, 0.1, 1.2}, steps, 1.3) - known).norm(), 1e-10);
}

TEST(PeriodicKernel, StokesletsOfOnePeriodHaveKnownDifferences) {
  const PeriodicCell cell(Mat3::Identity(), 1);
  const Six known = six(3.868593935259, 0.3110042702003, 0.4665064053004, 3.163052432329, 1.273574551257, 4.224364558376) -
                    six(-0.438916235253, 0.006098547955641, 0.00304927397782, 1.367480031487, 0.7959809689579, 0.1735085780498);
  for (const int steps : {1, 2})
    EXPECT_LT((stokeslet_at(cell, {0.1, 0.2, 0.3}, steps, 1.3) - stokeslet_at(cell, {0.4, 1.0, 0.5}, steps, 1.3) - known).norm(), 1e-10);
}

/// At a distance of five periods the other Fourier modes are of the order exp(-2 pi 5), so that (2.43) holds exactly.
TEST(PeriodicKernel, TheConstantOfOnePeriodVanishesAtItsReference) {
  for (const double period : {1., 0.7}) {
    const PeriodicCell cell(period * Mat3::Identity(), 1, 1.9);
    for (const int steps : {1, 3}) {
      const Six far = stokeslet_at(cell, {0.2, 3, 4}, steps, 6);
      EXPECT_NEAR(far[0], -4 / period * std::log(5 / 1.9), 1e-8);
      EXPECT_NEAR(far[3] + far[5], -4 / period * std::log(5 / 1.9) + 4 / period, 1e-8);
    }
  }
}

TEST(PeriodicKernel, CellsOfTheSameLatticeAreEqual) {
  const Vec3 r(0.31, -0.22, 0.43);
  const Mat3 tilted = rows({1, 0, 0}, {0, 1, 0}, {1, 0, 1});
  const Mat3 half = rows({1, 0, 0}, {0, 1, 0}, {0.5, 0, 1}), other = rows({1, 0, 0}, {0, 1, 0}, {-0.5, 0, 1});
  EXPECT_LT((stokeslet_at({tilted, 3}, r) - stokeslet_at({Mat3::Identity(), 3}, r)).norm(), 1e-11);
  EXPECT_LT((stokeslet_at({half, 3}, r) - stokeslet_at({other, 3}, r)).norm(), 1e-11);
  const PeriodicCell oblong(Vec3(1, 1, 2).asDiagonal(), 3);
  const Six two = stokeslet_at(oblong, r, 2) + stokeslet_at(oblong, r + Vec3(0, 0, 1), 2);
  EXPECT_LT((two - stokeslet_at({Mat3::Identity(), 3}, r)).norm(), 1e-10);
}

/// Returns int T_ijk n_k dGamma over a sphere of radius a about the origin, for the target x0; i is the row.
Mat3 over_sphere(const PeriodicCell& cell, const Vec3& x0, double a) {
  constexpr int n = 24;
  const auto& rule = quadrature::gauss(n);
  PeriodicSum sum(Kind::stresslet, cell, 1e-10, {Vec3::Constant(-0.5), Vec3::Constant(0.5)});
  std::vector<double> x[3], q[3][6];
  const std::vector<Vec3> target{sum.wrapped(x0)};
  Mat3 whole = Mat3::Zero();
  for (int k = 0; k < 2 * n * n; ++k) {
    const double z = 2 * rule.nodes[k % n] - 1, angle = pi * (k / n) / n, s = std::sqrt(1 - z * z), area = rule.weights[k % n] * 2 * pi * a * a / n;
    const Vec3 normal(s * std::cos(angle), s * std::sin(angle), z), at = sum.wrapped(a * normal);
    for (int c = 0; c < 3; ++c) x[c].push_back(at[c]);
    for (const Vec3& image : sum.images()) {
      const Vec3 r = at - target[0] + image;
      whole += area * -6 * r * r.transpose() * r.dot(normal) / std::pow(r.norm(), 5);
    }
    for (int j = 0; j < 3; ++j) {
      Mat3 charge = area / 2 * (Vec3::Unit(j) * normal.transpose() + normal * Vec3::Unit(j).transpose());
      const double six[6] = {charge(0, 0), charge(1, 1), charge(2, 2), charge(0, 1), charge(0, 2), charge(1, 2)};
      for (int c = 0; c < 6; ++c) q[j][c].push_back(six[c]);
    }
  }
  for (int j = 0; j < 3; ++j) {
    Vec3 u = Vec3::Zero();
    sum.add_remainder({2 * n * n, x[0].data(), x[1].data(), x[2].data(),
                  {q[j][0].data(), q[j][1].data(), q[j][2].data(), q[j][3].data(), q[j][4].data(), q[j][5].data()}}, target, u.data());
    whole.col(j) += u;
  }
  return whole;
}

TEST(PeriodicKernel, StressletsOverASphereAreThoseOfItsVolumeFraction) {
  const double a = 0.3, phi = 4 * pi / 3 * a * a * a;
  for (const Mat3& h : {Mat3(Mat3::Identity()), general()}) {
    const PeriodicCell cell(h, 3);
    const double share = phi / cell.volume();
    EXPECT_LT((over_sphere(cell, {0.02, 0.05, -0.03}, a) + 8 * pi * (1 - share) * Mat3::Identity()).norm(), 1e-8);
    EXPECT_LT((over_sphere(cell, {0.3, 0.3, 0.45}, a) - 8 * pi * share * Mat3::Identity()).norm(), 1e-7);
  }
  const PeriodicCell two(Mat3::Identity(), 2), one(Mat3::Identity(), 1);
  EXPECT_LT((over_sphere(two, {0.02, 0.05, -0.03}, a) + 8 * pi * Mat3::Identity()).norm(), 1e-8);
  EXPECT_LT((over_sphere(one, {0.02, 0.05, -0.03}, a) + 8 * pi * Mat3::Identity()).norm(), 1e-8);
}

/// Compares T = -p I + grad G + grad G^T with finite differences of the Stokeslet G. The pressure term, a multiple of I, is not compared.
TEST(PeriodicKernel, StressletsAreDifferencesOfStokeslets) {
  constexpr int number[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}}, stress[3][3] = {{0, 3, 4}, {3, 1, 5}, {4, 5, 2}};
  const Vec3 r(0.21, -0.17, 0.3);
  const double step = 1e-4;
  for (const int n : {1, 2, 3}) {
    const PeriodicCell cell(general(), n);
    Six slope[3];
    for (int k = 0; k < 3; ++k)
      slope[k] = (8 * (stokeslet_at(cell, r + step * Vec3::Unit(k)) - stokeslet_at(cell, r - step * Vec3::Unit(k))) -
                  (stokeslet_at(cell, r + 2 * step * Vec3::Unit(k)) - stokeslet_at(cell, r - 2 * step * Vec3::Unit(k)))) /
                 (12 * step);
    const std::vector<double> t = whole(Kind::stresslet, cell, r);
    for (int i = 0; i < 3; ++i) {
      Mat3 exact, found;
      for (int j = 0; j < 3; ++j)
        for (int k = 0; k < 3; ++k) {
          exact(j, k) = slope[k][number[i][j]] + slope[j][number[i][k]];
          found(j, k) = t[static_cast<std::size_t>(6 * i + stress[j][k])] / (j == k ? 1 : 2);
        }
      const Mat3 apart = found - exact;
      EXPECT_LT((apart - apart.trace() / 3 * Mat3::Identity()).norm(), 1e-8) << n << " periods";
    }
  }
}

/// Returns the largest error of sums over a cloud of sources, computed from near images and the rest, compared with the kernel itself.
double error_of_sums(Kind kind, const PeriodicCell& cell, double tolerance) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> side(-0.5, 0.5);
  constexpr int n = 10;
  const std::array<Vec3, 2> extent{Vec3::Constant(-0.5), Vec3::Constant(0.5)};
  PeriodicSum sum(kind, cell, tolerance, extent);
  std::vector<double> x[3], q[6];
  std::vector<Vec3> source, targets;
  const auto place = [&] { return Vec3(cell.vectors() * Vec3(side(random), side(random), side(random))); };
  for (int k = 0; k < n; ++k) {
    source.push_back(sum.wrapped(place()));
    targets.push_back(sum.wrapped(place()));
    for (int c = 0; c < 3; ++c) x[c].push_back(source.back()[c]);
    for (auto& charge : q) charge.push_back(side(random) + 0.1);
  }
  double mean[6] = {};
  for (int c = 0; c < 6; ++c)
    for (const double charge : q[c]) mean[c] += charge / n;
  for (int c = 0; c < 6; ++c)  // with one and two periods, sums are defined up to a constant times these means
    for (double& charge : q[c]) charge -= mean[c];
  std::vector<double> u(3 * n, 0.);
  sum.add_remainder({n, x[0].data(), x[1].data(), x[2].data(),
                {q[0].data(), q[1].data(), q[2].data(), q[3].data(), q[4].data(), q[5].data()}}, targets, u.data());
  double largest = 0;
  for (int i = 0; i < n; i += 5) {
    Vec3 found(&u[static_cast<std::size_t>(3 * i)]), exact = Vec3::Zero();
    for (int k = 0; k < n; ++k) {
      const Vec3 r = source[static_cast<std::size_t>(k)] - targets[static_cast<std::size_t>(i)];
      for (const Vec3& image : sum.images()) {
        const Vec3 y = r + image;
        const auto f = [&](int c) { return q[c][static_cast<std::size_t>(k)]; };
        if (kind == Kind::stokeslet)
          found += stokeslet(y) * Vec3(f(0), f(1), f(2));
        else
          found += -6 * y / std::pow(y.norm(), 5) *
                   (f(0) * y[0] * y[0] + f(1) * y[1] * y[1] + f(2) * y[2] * y[2] +
                    2 * (f(3) * y[0] * y[1] + f(4) * y[0] * y[2] + f(5) * y[1] * y[2]));
      }
      const std::vector<double> t = whole(kind, cell, r, 1, 1.5);
      for (int c = 0; c < 3; ++c) {
        constexpr int number[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
        if (kind == Kind::stokeslet)
          for (int j = 0; j < 3; ++j) exact[c] += t[static_cast<std::size_t>(number[c][j])] * q[j][static_cast<std::size_t>(k)];
        else
          for (int j = 0; j < 6; ++j) exact[c] += t[static_cast<std::size_t>(6 * c + j)] * q[j][static_cast<std::size_t>(k)];
      }
    }
    largest = std::max(largest, (found - exact).norm() / (n * (kind == Kind::stokeslet ? 0.3 * 2 : 0.3 * 4)));
  }
  return largest;
}

TEST(PeriodicSum, ItsErrorIsBelowTheTolerance) {
  const Mat3 tilted = rows({1, 0, 0}, {0, 1, 0}, {0.5, 0, 1}), oblong = Vec3(1, 1, 2).asDiagonal();
  for (const Kind kind : {Kind::stokeslet, Kind::stresslet}) {
    for (const double tolerance : {1e-4, 1e-6, 1e-8})
      for (const Mat3& h : {Mat3(Mat3::Identity()), tilted, oblong, general()})
        EXPECT_LT(error_of_sums(kind, {h, 3}, tolerance), tolerance);
    EXPECT_LT(error_of_sums(kind, {tilted, 3}, 1e-10), 1e-10);
    for (const int n : {1, 2}) EXPECT_LT(error_of_sums(kind, {general(), n}, 1e-6), 1e-6) << n << " periods";
  }
}

}  // namespace periodic_test
}  // namespace tanktread::stokes
