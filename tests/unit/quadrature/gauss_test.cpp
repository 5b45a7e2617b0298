#include "quadrature/gauss.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace tanktread::quadrature {
namespace {

double monomial(const GaussRule& rule, int degree) {
  double sum = 0;
  for (int i = 0; i < rule.size(); ++i) sum += rule.weights[i] * std::pow(rule.nodes[i], degree);
  return sum;
}

TEST(Gauss, IsExactToDegreeTwiceThePointsMinusOneAndNotBeyond) {
  for (const int n : {1, 2, 3, 5, 8, 16, 32, 64}) {
    const GaussRule& rule = gauss(n);
    for (int degree = 0; degree < 2 * n; ++degree)
      EXPECT_NEAR(monomial(rule, degree) * (degree + 1), 1, 1e-13) << n << " points, degree " << degree;
    // The error for x^2n is (n!)^4 / ((2n + 1) ((2n)!)^2): visible above round-off up to about n = 11.
    if (n <= 8) {
      EXPECT_GT(std::abs(monomial(rule, 2 * n) * (2 * n + 1) - 1), 1e-10) << n << " points";
    }
  }
}

TEST(Gauss, IsSymmetricAboutTheMiddleWithAscendingNodes) {
  for (const int n : {2, 7, 20}) {
    const GaussRule& rule = gauss(n);
    for (int i = 0; i < n; ++i) {
      EXPECT_DOUBLE_EQ(rule.nodes[i] + rule.nodes[n - 1 - i], 1);
      EXPECT_EQ(rule.weights[i], rule.weights[n - 1 - i]);
      if (i > 0) {
        EXPECT_LT(rule.nodes[i - 1], rule.nodes[i]);
      }
    }
  }
}

TEST(Gauss, TwoPointRuleIsTheKnownOne) {
  EXPECT_DOUBLE_EQ(gauss(2).nodes[0], 0.5 - 0.5 / std::sqrt(3.));
  EXPECT_DOUBLE_EQ(gauss(2).weights[0], 0.5);
}

TEST(Gauss, TensorRuleRunsFastestInSAndIsExactInBoth) {
  const TensorRule rule = tensor(gauss(2), gauss(3));
  ASSERT_EQ(rule.size(), 6);
  EXPECT_EQ(rule.s[1], gauss(2).nodes[1]);
  EXPECT_EQ(rule.t[1], gauss(3).nodes[0]);
  double integral = 0;
  for (int q = 0; q < rule.size(); ++q) integral += rule.weights[q] * std::pow(rule.s[q], 3) * std::pow(rule.t[q], 5);
  EXPECT_DOUBLE_EQ(integral, 1. / 24);
}

TEST(Gauss, KeepsItsRules) {
  const GaussRule* first = &gauss(6);
  gauss(40);
  EXPECT_EQ(first, &gauss(6));
}

}  // namespace
}  // namespace tanktread::quadrature
