#pragma once
// Assembly of sparse symmetric matrices from element matrices, and an iterative solver for sparse linear systems.

#include <span>
#include <vector>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>

namespace tanktread::spline {

/// Element matrix: adds factor * values(i, j) to the entry (unknowns[i], unknowns[j]). `unknowns` and `values` must exist until the assembly ends.
struct LocalMatrix {
  std::span<const int> unknowns;  ///< indices of the m unknowns of the element
  const Eigen::MatrixXd* values;  ///< symmetric matrix, shape at least (m, m); rows and columns beyond m are ignored
  double factor = 1;
};

/// Returns the sum of the element matrices, shape (n, n). The entry of two unknowns on one element is stored even if it is 0.
Eigen::SparseMatrix<double> assemble(int n, const std::vector<LocalMatrix>& local);

/// BiCGSTAB with the incomplete LU factors ILUT (Saad 1994) of Eigen. The inverses of mass and collocation matrices of splines decay within a few
/// elements. So with factors that have only a few more entries than the matrix, three or four iterations are enough for any size. The cost of factors
/// and solution is proportional to the number n of unknowns, whereas the cost of complete factors grows like n^1.5.
class IncompleteSolver {
 public:
  IncompleteSolver();

  /// Factors the square matrix A. A must exist as long as solve() is called, because the solver keeps a reference to it. Returns whether the
  /// factorisation succeeded.
  bool factor(const Eigen::SparseMatrix<double, Eigen::RowMajor>& a);

  /// Returns x = A^-1 b with a relative residual of 1e-14; if this is not reached, the result of 30 iterations. The iteration begins at `start`, if
  /// given, otherwise at 0. Several threads may call it.
  Eigen::VectorXd solve(const Eigen::VectorXd& b) const;
  Eigen::VectorXd solve(const Eigen::VectorXd& b, const Eigen::VectorXd& start) const;

 private:
  const Eigen::SparseMatrix<double, Eigen::RowMajor>* a_ = nullptr;
  Eigen::IncompleteLUT<double> factors_;
};

}  // namespace tanktread::spline
