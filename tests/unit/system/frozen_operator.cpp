// Tests of the frozen operator of the Jacobian, which is stored with 16 bits per entry.

#include <gtest/gtest.h>

#include "system/frozen/frozen_operator.hpp"

namespace tanktread::coupling {
namespace {

TEST(FrozenOperator, MultipliesByItsRowsToTheRoundingOfItsEntries) {
  const int n = 70;  // more rows than are assembled at a time
  Eigen::MatrixXf full(3 * n, 3 * n);
  for (int i = 0; i < n; ++i)
    for (int b = 0; b < n; ++b) {
      const Eigen::Matrix3f any = Eigen::Matrix3f::Random();
      full.block<3, 3>(3 * i, 3 * b) = any + any.transpose();
    }
  const std::vector<int> targets = {0, 3, 4, 10, 69};
  FrozenOperator frozen;
  frozen.assemble(targets, n, [&](std::span<const int> some, stokes::Rows<float>& rows) {
    rows.resize(3 * static_cast<Eigen::Index>(some.size()), 3 * n);
    for (size_t k = 0; k < some.size(); ++k) rows.middleRows<3>(3 * static_cast<Eigen::Index>(k)) = full.middleRows<3>(3 * some[k]);
  });
  const Net f = Net::Random(n, 3);
  Net u = Net::Constant(n, 3, 7);
  frozen.apply(f, u);
  const Eigen::VectorXd exact = full.cast<double>() * Eigen::Map<const Eigen::VectorXd>(f.data(), f.size());
  for (const int i : targets)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(u(i, c), exact[3 * i + c], 3 * n * 2 * std::ldexp(1.0, -9));  // 3 n products with |entry| <= 2, |f| <= 1, and a relative rounding
                                                                                // error of 2^-9
  EXPECT_EQ(u(1, 0), 7);  // rows of other targets are unchanged
}

}  // namespace
}  // namespace tanktread::coupling
