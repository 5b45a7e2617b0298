#pragma once
// Sparse linear systems with the same scalar matrix for several right-hand sides, as the three components of a net.

#include <memory>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "membrane/options.hpp"

namespace tanktread::membrane {

/// Up to three right-hand sides or solutions, one a column.
using Columns = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, Eigen::Dynamic, 3>;

/// A direct solver of Amesos2 on a matrix that every rank holds whole. Each rank solves for itself: short vectors are replicated, so
/// there is no message, nothing depends on the number of ranks, and KLU2's faulty solve on several ranks (Trilinos 13.2) is never used.
class DirectSolver {
 public:
  /// Throws UserError for a solver that this Amesos2 does not have, or a list that it does not take.
  explicit DirectSolver(const DirectSolverOptions& options = {});
  ~DirectSolver();
  DirectSolver(DirectSolver&&) noexcept;
  DirectSolver& operator=(DirectSolver&&) noexcept;

  /// Factors A (square). Of blocks on its diagonal that are equal, as those of equal particles, one is factored. A solve with a known solution
  /// follows, and a relative residual above 1e-8 throws: RunFailure for a singular matrix, UserError where the chosen solver does not suit the
  /// matrix (Tacho is for symmetric positive definite ones).
  void factor(const Eigen::SparseMatrix<double>& a);

  /// x = A^-1 b, of one shape; they may be the same object.
  void solve(const Columns& b, Columns& x) const;
  Net solve(const Net& b) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tanktread::membrane
