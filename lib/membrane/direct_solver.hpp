#pragma once
// Sparse linear systems with one scalar matrix and several right-hand sides, such as the three components of a net.

#include <memory>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "membrane/options.hpp"

namespace tanktread::membrane {

/// Up to three right-hand sides or solutions, one per column.
using RightHandSides = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor, Eigen::Dynamic, 3>;

/// Direct solver of Amesos2 for a matrix that every rank holds completely. Every rank solves the whole system, because short vectors are replicated
/// on all ranks. So there is no communication, the result does not depend on the number of ranks, and KLU2's faulty solve on several ranks (Trilinos
/// 13.2) is never used.
class DirectSolver {
 public:
  /// Throws UserError if this build's Amesos2 does not have the solver. factor() throws UserError if the solver rejects its parameter list.
  explicit DirectSolver(const DirectSolverOptions& options = {});
  ~DirectSolver();
  DirectSolver(DirectSolver&&) noexcept;
  DirectSolver& operator=(DirectSolver&&) noexcept;

  /// Factors A (square). If diagonal blocks are equal, for example the blocks of equal particles, only one of them is factored. As a check, solves a
  /// system with a known solution. If the relative residual exceeds 1e-8, throws RunFailure for a singular matrix, or UserError if the chosen solver
  /// does not suit the matrix (Tacho requires a symmetric positive definite matrix).
  void factor(const Eigen::SparseMatrix<double>& a);

  /// Computes x = A^-1 b. b and x have the same shape and may be the same object.
  void solve(const RightHandSides& b, RightHandSides& x) const;
  Net solve(const Net& b) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tanktread::membrane
