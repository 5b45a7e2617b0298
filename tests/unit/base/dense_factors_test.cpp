#include "base/dense_factors.hpp"

#include <gtest/gtest.h>

namespace tanktread {
namespace {

TEST(DenseFactors, SolveSystemsThatNeedPivots) {
  for (const int n : {1, 3, 40, 301}) {  // 301: larger than a block of the factorisation, and not a multiple of the register width
    Eigen::MatrixXd a(n, n), x(n, 2);
    for (int i = 0; i < n; ++i) {
      for (int j = 0; j < n; ++j) a(i, j) = std::cos(1.3 * i * i + 0.7 * j + 0.01 * i * j * j);
      x.row(i) << std::cos(i), 1. / (1 + i);
    }
    if (n > 1) a(0, 0) = 0;
    const DenseFactors factors(a);
    const double rounding = 1e-15 * n * (a.norm() * factors.inverse().norm());
    EXPECT_LT((factors.solve(a * x) - x).norm(), rounding * x.norm()) << n;
    EXPECT_LT((factors.solve_transposed(a.transpose() * x.col(0)) - x.col(0)).norm(), rounding * x.norm()) << n;
    EXPECT_LT((factors.inverse() * a - Eigen::MatrixXd::Identity(n, n)).norm(), rounding) << n;
  }
}

}  // namespace
}  // namespace tanktread
