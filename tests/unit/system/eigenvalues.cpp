// Tests of the eigenpairs of dense matrices.

#include <algorithm>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "system/solvers/eigenvalues.hpp"

namespace tanktread::coupling {
namespace {

// Two equal blocks have each pair of conjugate eigenvalues twice, with independent eigenvectors.
TEST(Eigenvalues, RepeatedConjugatePairsHaveIndependentVectors) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(5, 5);
  for (int k = 0; k < 4; k += 2) a.block<2, 2>(k, k) << 0.5, -2, 2, 0.5;
  a(4, 4) = 3;
  const std::vector<Eigenpair> pairs = eigenpairs(a);
  ASSERT_EQ(pairs.size(), 5);
  Eigen::MatrixXcd vectors(5, 5);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    vectors.col(static_cast<Eigen::Index>(k)) = pairs[k].vector;
    const Eigen::VectorXcd residual = a.cast<std::complex<double>>() * pairs[k].vector - pairs[k].value * pairs[k].vector;
    EXPECT_LT(residual.norm(), 1e-14 * a.norm());  // rounding errors of a normal matrix
  }
  EXPECT_EQ(Eigen::FullPivLU<Eigen::MatrixXcd>(vectors).setThreshold(1e-8).rank(), 5);
}

}  // namespace
}  // namespace tanktread::coupling
