#include "base/dense_factors.hpp"

#include <cassert>
#include <utility>

namespace tanktread {

DenseFactors::DenseFactors(Eigen::MatrixXd a) : factors_(std::move(a)), row_of_(static_cast<std::size_t>(factors_.rows())) {
  assert(factors_.rows() == factors_.cols());
  factor(static_cast<int>(factors_.rows()), factors_.data(), row_of_.data());
}

Eigen::MatrixXd DenseFactors::solve(const Eigen::Ref<const Eigen::MatrixXd>& b) const {
  assert(b.rows() == factors_.rows());
  Eigen::MatrixXd x(b.rows(), b.cols());
  for (Eigen::Index i = 0; i < x.rows(); ++i) x.row(row_of_[static_cast<std::size_t>(i)]) = b.row(i);
  solve_triangles(static_cast<int>(x.rows()), factors_.data(), static_cast<int>(x.cols()), x.data());
  return x;
}

Eigen::VectorXd DenseFactors::solve_transposed(const Eigen::VectorXd& b) const {
  assert(b.rows() == factors_.rows());
  Eigen::VectorXd y = b, x(b.rows());
  factors_.transpose().triangularView<Eigen::Lower>().solveInPlace(y);
  factors_.transpose().triangularView<Eigen::UnitUpper>().solveInPlace(y);
  for (Eigen::Index i = 0; i < x.rows(); ++i) x[i] = y[row_of_[static_cast<std::size_t>(i)]];
  return x;
}

}  // namespace tanktread
