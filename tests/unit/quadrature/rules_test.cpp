// Compares rules for singular and nearly singular integrands on the unit square with the exact potential of a flat rectangle.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <tuple>
#include <vector>

#include "quadrature/ellipse.hpp"
#include "quadrature/gauss.hpp"
#include "quadrature/graded.hpp"
#include "quadrature/polar.hpp"

namespace tanktread::quadrature {
namespace {

/// Returns the integral over [0, a] x [0, b] of 1 / sqrt((x - x0)^2 + (y - y0)^2 + z0^2), from its antiderivative at the corners.
double potential(double a, double b, const Vec3& target) {
  const auto corner = [&](double x, double y) {
    const double z = target[2], r = std::sqrt(x * x + y * y + z * z);
    const double first = std::abs(x) > 0 ? x * std::asinh(y / std::hypot(x, z)) : 0,
                 second = std::abs(y) > 0 ? y * std::asinh(x / std::hypot(y, z)) : 0;
    return first + second - (z > 0 ? z * std::atan(x * y / (z * r)) : 0);
  };
  const double left = -target[0], right = a - target[0], low = -target[1], high = b - target[1];
  return corner(right, high) - corner(left, high) - corner(right, low) + corner(left, low);
}

double integral(const Rule& rule, double a, double b, const Vec3& target) {
  double sum = 0;
  for (int q = 0; q < rule.size(); ++q) sum += a * b * rule.weights[q] / (Vec3(a * rule.s[q], b * rule.t[q], 0) - target).norm();
  return sum;
}

double area(const Rule& rule) { return std::accumulate(rule.weights.begin(), rule.weights.end(), 0.); }

constexpr double places[][2] = {{0, 0}, {1, 0}, {1, 1}, {0.3, 0}, {1, 0.7}, {0.5, 0.5}, {0.02, 0.4}, {0.97, 0.99}};

Rule made(double s, double t, MetricBin metric, double tolerance) { return polar(s, t, metric, polar_orders(s, t, metric, 4, tolerance)); }

TEST(Polar, IntegratesTheSingularityForAnyTarget) {
  for (const auto& [s, t] : places)
    for (const double b : {1., 3., 0.2})
      for (const double tolerance : {1e-4, 1e-8, 1e-12}) {
        const Rule rule = made(s, t, metric_bin(1, 0, b * b), tolerance);
        const double exact = potential(1, b, Vec3(s, b * t, 0));
        EXPECT_NEAR(integral(rule, 1, b, Vec3(s, b * t, 0)), exact, tolerance * exact) << s << ' ' << t << ' ' << b;
        EXPECT_NEAR(area(rule), 1,
                    20 * tolerance);  // the integrand of the area grows with cosh^2 of mu, faster than the rule is made for
      }
}

TEST(Polar, IsAccurateOnShearedElements) {
  const double s = 0.3, t = 0.6;
  const Vec3 u(1, 0, 0), v(1.2, 0.5, 0);  // tangents with an angle of 23 degrees
  const auto value = [&](const Rule& rule) {
    double sum = 0;
    for (int q = 0; q < rule.size(); ++q) sum += rule.weights[q] / ((rule.s[q] - s) * u + (rule.t[q] - t) * v).norm();
    return sum;
  };
  const double exact = value(made(s, t, metric_bin(1, 1.2, 1.69), 1e-15));
  const Rule with = made(s, t, metric_bin(1, 1.2, 1.69), 1e-6), without = made(s, t, MetricBin{}, 1e-6);
  EXPECT_NEAR(value(with), exact, 1e-6 * exact);
  EXPECT_GT(std::abs(value(without) - exact), 1e-6 * exact);
}

TEST(MetricBin, FindsTheBinOfAMetric) {
  EXPECT_EQ(metric_bin(1, 0, 1), (MetricBin{0, 6}));
  EXPECT_EQ(metric_bin(1, 0, 4.1), (MetricBin{2, 6}));
  EXPECT_EQ(metric_bin(4, 0, 1), (MetricBin{-2, 6}));
  EXPECT_EQ(metric_bin(1, 0.5, 1), (MetricBin{0, 4}));  // 60 degrees
  EXPECT_EQ(metric_bin(1, -0.5, 1), (MetricBin{0, 8}));
  EXPECT_EQ(metric_bin(0, 0, 1), (MetricBin{0, 6}));  // degenerate metric
}

TEST(LachatWatson, ConvergesAtACornerAndIsPoorCloseToAnEdge) {
  const double corner = potential(1, 1, Vec3::Zero()), edge = potential(1, 1, Vec3(0.02, 0.4, 0));
  EXPECT_NEAR(integral(lachat_watson(0, 0, 8), 1, 1, Vec3::Zero()), corner, 1e-8 * corner);
  EXPECT_NEAR(area(lachat_watson(0.02, 0.4, 8)), 1, 1e-14);
  EXPECT_GT(std::abs(integral(lachat_watson(0.02, 0.4, 8), 1, 1, Vec3(0.02, 0.4, 0)) - edge), 1e-4 * edge);
}

/// Returns the Bezier points of degree 1 of a rectangle.
std::vector<double> rectangle(double a, double b) { return {0, a, 0, a, 0, 0, b, b, 0, 0, 0, 0}; }

TEST(Graded, KeepsTheToleranceAtAnyDistance) {
  for (const auto& [s, t] : places)
    for (const double b : {1., 4.})
      for (const double distance : {2., 0.3, 1e-2, 1e-4, 1e-7})
        for (const double tolerance : {1e-4, 1e-8, 1e-11}) {
          const Vec3 target(s, b * t, distance);
          const double exact = potential(1, b, target);
          Rule rule;  // has about twenty parts, and the error of each may be as large as `allowed`
          graded(rectangle(1, b), 1, target, {.allowed = tolerance * exact / 20, .tolerance = tolerance}, rule);
          EXPECT_NEAR(integral(rule, 1, b, target), exact, tolerance * exact) << s << ' ' << t << ' ' << distance;
          EXPECT_NEAR(area(rule), 1, 1e-13);
        }
}

TEST(Graded, CostsTheLogarithmOfTheDistance) {
  const auto points = [](double distance) {
    Rule rule;
    graded(rectangle(1, 1), 1, Vec3(0.4, 0.3, distance), {.allowed = 1e-8, .tolerance = 1e-8}, rule);
    return rule.size();
  };
  EXPECT_LT(points(1e-6) - points(1e-4), 1.5 * (points(1e-4) - points(1e-2)));
}

TEST(Graded, EndsOnAnElementThatIsNotFiniteOrTooDistorted) {
  for (const double size : {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN(), 1e200}) {  // 1e200: squares overflow
    Rule rule;
    graded(rectangle(1, size), 1, Vec3(0.4, 0.3, 0.1), {.allowed = 1e-8, .tolerance = 1e-8}, rule);
    EXPECT_TRUE(std::isnan(rule.weights.back())) << size;
    EXPECT_LT(rule.size(), 1e6);
  }
}

TEST(Ellipse, PredictsTheErrorOfGauss) {
  for (const double height : {0.3, 1., 2.}) {
    const double rho = ellipse(0, height), exact = 2 * std::asinh(1 / height);
    const int n = order_for(1e-8, rho);
    const GaussRule& rule = gauss(n);
    double sum = 0;
    for (int q = 0; q < n; ++q) sum += 2 * rule.weights[q] / std::hypot(2 * rule.nodes[q] - 1, height);
    EXPECT_LT(std::abs(sum - exact), 1e-7 * exact);   // the error is rho^(-2 n) up to a factor of about three
    EXPECT_GT(std::abs(sum - exact), 1e-12 * exact);  // the order is not much larger than needed
  }
}

TEST(Sight, FindsTheNearestPointOfAPatch) {
  const Patch patch{Vec3::Zero(), Vec3(1, 0, 0), Vec3(0, 2, 0)};
  EXPECT_DOUBLE_EQ(sight(patch, Vec3(0.3, 1, 0.5)).distance, 0.5);
  EXPECT_DOUBLE_EQ(sight(patch, Vec3(3, 0, 0)).distance, 2);
  // rho = |z + sqrt(z^2 - 1)|, where z is the singularity of 1/r if the parameter along u is continued into the complex plane; |z| <= 1 on the patch.
  EXPECT_NEAR(sight(patch, Vec3(3, 0, 0)).rho_u, 3 + std::sqrt(8), 1e-14);   // target in the plane of the patch: z = 3
  EXPECT_NEAR(sight(patch, Vec3(0, 0, 1)).rho_u, 1 + std::sqrt(2.), 1e-14);  // target above the centre of the patch: z = i
}

}  // namespace
}  // namespace tanktread::quadrature
