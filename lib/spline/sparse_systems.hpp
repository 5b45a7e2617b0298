#pragma once
// Sparse symmetric matrices that are sums over elements, and linear systems by iteration.

#include <memory>
#include <span>
#include <vector>

#include <Eigen/SparseCore>

namespace tanktread::spline {

/// What one element adds: factor * values(i, j) to the entry of unknowns i and j of its own. Both must outlive the sum.
struct LocalMatrix {
  std::span<const int> unknowns;  ///< m of them
  const Eigen::MatrixXd* values;  ///< shape (m, m) or larger, symmetric
  double factor = 1;
};

/// The sum, shape (n, n); entries where two unknowns meet on an element are kept even if they are 0.
Eigen::SparseMatrix<double> assemble(int n, const std::vector<LocalMatrix>& local);

/// BiCGSTAB with the incomplete factors ILUT (Saad 1994) of Eigen. Mass and collocation matrices of splines have inverses that fade within a few
/// elements, so factors with hardly more entries than the matrix leave three or four iterations, whatever the size: set-up and solution grow
/// with the number of unknowns, where complete factors grow like its power 1.5.
class IncompleteSolver {
 public:
  IncompleteSolver();
  ~IncompleteSolver();
  IncompleteSolver(IncompleteSolver&&) noexcept;

  /// Factors A (square), which must stay where it is; whether that can be done.
  bool factor(const Eigen::SparseMatrix<double, Eigen::RowMajor>& a);

  /// x = A^-1 b to a relative residual of 1e-14, or what is left of it after 30 iterations from `start`, or from 0.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  Eigen::VectorXd solve(const Eigen::VectorXd& b, const Eigen::VectorXd& start) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tanktread::spline
