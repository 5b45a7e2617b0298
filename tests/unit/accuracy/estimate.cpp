#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "accuracy/estimate.hpp"

namespace tanktread::accuracy {
namespace {

const double nan = std::numeric_limits<double>::quiet_NaN();

/// Expected sizes of the errors of the levels 0 to `last`, and the differences of successive levels of a quantity with errors factor x size^power.
struct Sequence {
  std::vector<double> expected, differences;

  Sequence(double factor, double power, int last) {
    const std::vector<double> sizes{1, 0.28, 0.09, 0.023, 0.007, 0.002};
    expected.assign(sizes.begin(), sizes.begin() + last + 1);
    for (int k = 1; k <= last; ++k) differences.push_back(factor * (std::pow(sizes[k - 1], power) - std::pow(sizes[k], power)));
  }
};

Estimate of(const std::vector<double>& differences) {
  std::vector<double> expected{1};
  while (expected.size() <= differences.size()) expected.push_back(expected.back() / 3);
  return estimated(differences, 1, expected);
}

TEST(Estimate, IsTheErrorIfErrorsAreProportionalToTheExpectedOnes) {
  for (int last = 2; last <= 5; ++last) {
    const Sequence sequence(0.1, 1, last);
    const Estimate found = estimated(sequence.differences, 1, sequence.expected);
    EXPECT_TRUE(found.trusted()) << found.untrusted;
    EXPECT_NEAR(found.error, 0.1 * sequence.expected.back(), 1e-15);
    EXPECT_NEAR(found.ratio, sequence.expected[last - 1] / sequence.expected[last], 1e-12);
  }
}

TEST(Estimate, IsWithinAFactorOfThreeIfErrorsHaveAnotherOrder) {
  for (const double power : {0.7, 0.85, 1.2, 1.3})
    for (int last = 2; last <= 5; ++last) {
      const Sequence sequence(0.1, power, last);
      const Estimate found = estimated(sequence.differences, 1, sequence.expected);
      const double factor = found.error / (0.1 * std::pow(sequence.expected.back(), power));
      EXPECT_TRUE(found.trusted()) << found.untrusted;
      EXPECT_GT(factor, 1. / 3) << power;
      EXPECT_LT(factor, 3.) << power;
    }
}

/// Changes between three levels of a curve with the errors a(t) E + b(t) E^(6/4.25), and the largest error on the finest level. `sign`: factor of b.
struct TwoOrders {
  std::array<double, 3> expected{1, 0.28, 0.09};
  std::vector<Curve> changes{2};
  double error = 0;

  explicit TwoOrders(double sign) {
    const auto at_level = [&](double t, std::size_t level) {
      return std::cos(t) * expected[level] + sign * (2 + std::sin(t)) * std::pow(expected[level], 6 / 4.25);
    };
    for (int k = 0; k <= 20; ++k) {
      const double t = 0.1 * k;
      for (std::size_t level : {1, 2})
        changes[level - 1].at.push_back(t), changes[level - 1].values.push_back(at_level(t, level) - at_level(t, level - 1));
      error = std::max(error, std::abs(at_level(t, 2)));
    }
  }
  std::vector<double> sizes() const { return {expected.begin(), expected.end()}; }
};

TEST(TwoOrderError, IsTheErrorIfErrorsHaveTheTwoOrders) {
  for (const double sign : {1., 0., -0.8}) {
    const TwoOrders errors(sign);
    EXPECT_NEAR(two_order_error(errors.changes[0], errors.changes[1], errors.expected), errors.error, 1e-14) << sign;
  }
}

TEST(TwoOrderError, InterpolatesTheChangeOfTheCoarserLevels) {
  TwoOrders errors(-0.8);
  Curve& before = errors.changes[0];
  before.at.erase(before.at.begin() + 7), before.values.erase(before.values.begin() + 7);
  EXPECT_NEAR(two_order_error(before, errors.changes[1], errors.expected), errors.error, 1e-6);  // cubic interpolation over 0.2
  EXPECT_TRUE(std::isnan(two_order_error({{7}, {1}}, errors.changes[1], errors.expected)));
}

// With a second order of opposite sign, errors fall faster than expected, so that the estimate (9.1) from the last difference is too large.
TEST(Estimate, UsesTheSignsOfChanges) {
  const TwoOrders errors(-0.8);
  const Estimate with_signs = estimated(errors.changes, 1, errors.sizes());
  const Estimate without = estimated({largest(errors.changes[0].values), largest(errors.changes[1].values)}, 1, errors.sizes());
  EXPECT_GT(std::abs(std::log(without.error / errors.error)), std::abs(std::log(with_signs.error / errors.error)));
  EXPECT_EQ(with_signs.ratio, without.ratio);
}

TEST(Estimate, MeetsARequestOnlyIfTheErrorDoesWhenErrorsAreProportionalToTheExpectedOnes) {
  const TwoOrders errors(0);
  EXPECT_GE(margin * estimated(errors.changes, 1, errors.sizes()).error, errors.error);
}

TEST(Estimate, NeedsThreeLevels) {
  EXPECT_FALSE(of({}).trusted());
  EXPECT_FALSE(of({1e-2}).trusted());
  EXPECT_TRUE(of({1e-2, 3e-3}).trusted());
}

TEST(Estimate, IsNotTrustedIfDifferencesDoNotFallRegularly) {
  EXPECT_FALSE(of({1e-2, 9e-3}).trusted());          // hardly fall
  EXPECT_FALSE(of({1e-3, 3e-3}).trusted());          // grow
  EXPECT_FALSE(of({1e-2, 1e-4}).trusted());          // fall by chance
  EXPECT_FALSE(of({1e-2, 3e-3, 3.3e-3}).trusted());  // stagnate
  EXPECT_FALSE(of({1e-2, nan}).trusted());
  EXPECT_TRUE(std::isnan(of({1e-2, nan}).error));
}

TEST(Estimate, UsesTwoRatiosIfTheLastOneIsUnusual) {
  EXPECT_TRUE(of({1.6e-2, 1.3e-3, 1e-3}).trusted());  // 16 in two levels
}

TEST(Estimate, OfRoundOffIsRoundOff) {
  const Estimate found = of({3e-13, 4e-13});
  EXPECT_TRUE(found.trusted());
  EXPECT_DOUBLE_EQ(found.error, 4e-13);
}

TEST(Difference, IsTakenAtTimesThatBothCurvesHave) {
  Curve a, b;
  for (int k = 0; k <= 12; ++k) a.at.push_back(k / 12.), a.values.push_back(std::exp(k / 12.));
  for (int k = 0; k <= 18; ++k) b.at.push_back(k / 18.), b.values.push_back(std::exp(k / 18.) + 0.1);
  const Curve found = difference(a, b);
  ASSERT_EQ(found.at.size(), 7u);
  for (const double value : found.values) EXPECT_NEAR(value, -0.1, 1e-14);  // no error of interpolation
}

TEST(Difference, InterpolatesIfThereAreTooFewSuchTimes) {
  Curve a, b;
  for (int k = 0; k <= 10; ++k) a.at.push_back(k / 10. + 1e-3), a.values.push_back(std::pow(a.at.back(), 3));
  for (int k = 0; k <= 13; ++k) b.at.push_back(k / 12.), b.values.push_back(std::pow(b.at.back(), 3) + 0.1);
  const Curve found = difference(a, b);
  ASSERT_EQ(found.at.size(), 11u);
  for (const double value : found.values) EXPECT_NEAR(value, -0.1, 1e-12);  // cubics are exact
}

TEST(Difference, InterpolatesIfTheCommonTimesMissTheValues) {
  Curve a, b;  // the common times are those at which the oscillation passes through zero
  for (int k = 0; k <= 200; ++k) a.at.push_back(k / 20.), a.values.push_back(std::sin(std::numbers::pi * k / 20.));
  for (int k = 0; k <= 300; ++k) b.at.push_back(k / 30. + (k % 30 == 0 ? 0 : 1e-3));
  for (const double at : b.at) b.values.push_back(1.1 * std::sin(std::numbers::pi * at));
  EXPECT_NEAR(largest(difference(a, b).values), 0.1, 1e-3);  // error of the interpolation: (pi/30)^4/60
}

TEST(Difference, OfAnglesIsAtMostHalfAPeriod) {
  const Curve a{{0, 1, 2}, {80, 89.9, -80}}, b{{0, 1, 2}, {80.1, -89.9, -79.8}};
  EXPECT_NEAR(largest(difference(a, b, 180).values), 0.2, 1e-12);
}

TEST(Difference, IsNanIfACurveIsNan) {
  const Curve a{{0, 1, 2}, {1, nan, 3}}, b{{0, 1, 2}, {1, 2, 3.5}};
  EXPECT_DOUBLE_EQ(largest(difference(a, b).values), 0.5);
  EXPECT_TRUE(std::isnan(largest({nan, nan})));
}

TEST(Average, IsTheIntegralDividedByTheTime) {
  EXPECT_DOUBLE_EQ(average({{0, 1}, {0, 2}}).value, 1);
  EXPECT_DOUBLE_EQ(average({{3}, {5}}).value, 5);
  EXPECT_NEAR(average({{0, 1, 1.5, 3, 4}, {0, 1, 3.375, 27, 64}}).value, 16, 1e-12);  // cubics are exact
  EXPECT_DOUBLE_EQ(average({{0, 1, 1, 2}, {0, 0, 1, 1}}).value, 0.5);                 // an abscissa of two values is a jump
}

TEST(Average, HasAnEstimateOfItsQuadratureError) {
  const auto sampled = [](int n, double (*f)(double)) {
    Curve curve;
    for (int k = 0; k <= n; ++k) curve.at.push_back(static_cast<double>(k) / n), curve.values.push_back(f(curve.at.back()));
    return average(curve);
  };
  for (const int n : {20, 40, 80}) {
    const Average smooth = sampled(n, [](double x) { return std::sin(9 * x); });
    const double error = std::abs(smooth.value - (1 - std::cos(9.)) / 9);
    EXPECT_GT(smooth.error, error / 3) << n;
    // Measured ratios: 9.5, 0.6 and 3.3. They differ because the quadrature errors with all points, every second and every fourth point may differ in
    // sign.
    EXPECT_LT(smooth.error, 30 * error) << n;
    const Average jump = sampled(n, [](double x) { return x < 0.51 ? 0. : 1.; });
    EXPECT_GT(jump.error, std::abs(jump.value - 0.49) / 3) << n;
  }
}

TEST(StatisticalError, IsTheStandardErrorOfIndependentParts) {
  Curve curve;
  for (int k = 0; k <= 800; ++k) curve.at.push_back(k), curve.values.push_back(k / 100 % 2 ? 1. : -1.);
  EXPECT_NEAR(statistical_error(curve), std::sqrt(1. / 7), 1e-2);  // eight averages of 1 or -1
  EXPECT_TRUE(std::isnan(statistical_error({{0, 1}, {0, 1}})));
}

TEST(Envelope, HasNoZerosBetweenLargerValues) {
  const std::vector<double> found = envelope({{0, 1, 2, 3}, {1, 0, 2, 4}}, {0, 0.5, 1, 2.5, 3, 3.5});
  EXPECT_EQ(found, (std::vector<double>{1, 2, 2, 4, 4, 4}));
}

}  // namespace
}  // namespace tanktread::accuracy
