#pragma once
// LU factors of dense matrices that are factored once and solved many times.

#include <vector>

#include "base/types.hpp"

namespace tanktread {

/// LU factors of a square matrix with partial pivoting, P A = L U, stored in place of the matrix.
class DenseFactors {
 public:
  DenseFactors() = default;
  explicit DenseFactors(Eigen::MatrixXd a);

  /// Returns A^-1 b. b may have several columns.
  Eigen::MatrixXd solve(const Eigen::Ref<const Eigen::MatrixXd>& b) const;
  Eigen::VectorXd solve_transposed(const Eigen::VectorXd& b) const;  ///< returns A^-T b
  Eigen::MatrixXd inverse() const { return solve(Eigen::MatrixXd::Identity(factors_.rows(), factors_.rows())); }

 private:
  Eigen::MatrixXd factors_;
  std::vector<int> row_of_;  // permutation: row i of A is row row_of_[i] of P A
};

/// Replaces A, shape (n, n), by the factors L (with ones on the diagonal) and U of P A. Row i of A is row row_of[i] of P A.
void factor(int n, double* a, int* row_of);

/// Replaces x, shape (n, columns), by U^-1 L^-1 x.
void solve_triangles(int n, const double* factors, int columns, double* x);

}  // namespace tanktread
