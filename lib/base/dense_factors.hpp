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

/// Puts the factors L (with ones on the diagonal) and U of P A in the place of A of shape (n, n); row i of A is row row_of[i] of P A.
void factor(int n, double* a, int* row_of);

/// x = U^-1 L^-1 x for the columns of x, shape (n, columns).
void solve_triangles(int n, const double* factors, int columns, double* x);

}  // namespace tanktread
