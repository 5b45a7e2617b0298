#pragma once
// Dense systems that are factored once and solved many times.

#include <vector>

#include "base/types.hpp"

namespace tanktread {

/// P A = L U of a square matrix, with partial pivoting, in its place.
class DenseFactors {
 public:
  DenseFactors() = default;
  explicit DenseFactors(Eigen::MatrixXd a);

  /// A^-1 b; b and A^-1 b may have several columns.
  Eigen::MatrixXd solve(const Eigen::Ref<const Eigen::MatrixXd>& b) const;
  Eigen::VectorXd solve_transposed(const Eigen::VectorXd& b) const;  ///< A^-T b
  Eigen::MatrixXd inverse() const { return solve(Eigen::MatrixXd::Identity(factors_.rows(), factors_.rows())); }

 private:
  Eigen::MatrixXd factors_;
  std::vector<int> row_of_;  // of P A: that of row i of A
};

}  // namespace tanktread
