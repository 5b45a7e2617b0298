#pragma once
// Sparse linear systems by iteration, preconditioned by an incomplete factorisation.

#include <memory>

#include <Eigen/SparseCore>

namespace tanktread::membrane {

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

  /// x = A^-1 b to a relative residual of 1e-14, or what is left of it after 30 iterations.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tanktread::membrane
