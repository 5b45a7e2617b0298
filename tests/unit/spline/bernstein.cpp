#include "spline/bernstein.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace tanktread::spline {
namespace {

constexpr double rounding = 1e-14;  // round-off of sums of a few dozen products of numbers below 1

TEST(Bernstein, ValuesAreTheBinomialFormulaAndSumToOne) {
  for (int p = 1; p <= 6; ++p)
    for (double x : {0.0, 0.125, 0.4, 1.0}) {
      double b[16], sum = 0;
      bernstein(p, x, b);
      for (int i = 0; i <= p; ++i) {
        const double binomial = std::tgamma(p + 1) / (std::tgamma(i + 1) * std::tgamma(p - i + 1));
        EXPECT_NEAR(b[i], binomial * std::pow(x, i) * std::pow(1 - x, p - i), rounding);
        sum += b[i];
      }
      EXPECT_NEAR(sum, 1, rounding);
    }
}

TEST(Bernstein, DerivativesAreThoseOfThePowers) {
  // sum_i (i / p) B_i = x, and sum_i i (i - 1) / (p (p - 1)) B_i = x^2.
  for (int p = 2; p <= 6; ++p) {
    const double x = 0.3;
    double b[16], d[16], dd[16];
    bernstein(p, x, b, d, dd);
    double first[2] = {0, 0}, second[2] = {0, 0};
    for (int i = 0; i <= p; ++i) {
      const double linear = double(i) / p, square = double(i) * (i - 1) / (p * (p - 1));
      first[0] += linear * d[i];
      first[1] += linear * dd[i];
      second[0] += square * d[i];
      second[1] += square * dd[i];
    }
    EXPECT_NEAR(first[0], 1, 10 * rounding);
    EXPECT_NEAR(first[1], 0, 100 * rounding);
    EXPECT_NEAR(second[0], 2 * x, 10 * rounding);
    EXPECT_NEAR(second[1], 2, 100 * rounding);
  }
}

TEST(Bernstein, ElevationAndRestrictionKeepThePolynomial) {
  const Eigen::Vector4d c(0.3, -1.2, 2.0, 0.7);
  const Eigen::VectorXd up = elevation(3, 5) * c, part = restriction(3, 0.25, 0.75) * c;
  for (double x : {0.0, 0.2, 0.9}) {
    double b3[16], b5[16], inside[16];
    bernstein(3, x, b3);
    bernstein(5, x, b5);
    bernstein(3, 0.25 + 0.5 * x, inside);
    EXPECT_NEAR(Eigen::Map<Eigen::VectorXd>(b5, 6).dot(up), Eigen::Map<Eigen::VectorXd>(b3, 4).dot(c), rounding);
    EXPECT_NEAR(Eigen::Map<Eigen::VectorXd>(b3, 4).dot(part), Eigen::Map<Eigen::VectorXd>(inside, 4).dot(c), rounding);
  }
}

}  // namespace
}  // namespace tanktread::spline
