#pragma once
// Systems with the mass matrices of a moving surface.

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "membrane/symmetric_solver.hpp"

namespace tanktread::membrane {

/// Solves with the mass matrix M0 of the unstressed surface, which Amesos2 factors once a mesh (3.7), and with the mass matrix S of any later
/// configuration (3.6), by conjugate gradients with D M0 D as preconditioner, D_A^2 = S_AA/M0_AA. The two differ by how much the stretch varies
/// over the support of one function, so a handful of iterations does what a new factorisation would at a tenth of its cost; where it does
/// not, S is factored. No memory of earlier configurations: the answer depends on S alone. Of symmetric surfaces and fields only the fundamental part
/// is solved for.
class MassSolver {
 public:
  explicit MassSolver(const DirectSolverOptions& options = {}, const surface::Symmetry& symmetry = surface::Symmetry());

  /// Factors M0. Throws as DirectSolver does.
  void factor(const Eigen::SparseMatrix<double>& m0);

  /// M0^-1.
  const SymmetricSolver& reference() const { return reference_; }

  /// M0^-1 d, shape (N, 3).
  Net solve(const Net& d) const { return reference_.solve(d); }

  /// S^-1 d to a relative residual of 1e-13 in each component.
  Net solve(const Eigen::SparseMatrix<double>& s, const Net& d);

  int iterations() const { return iterations_; }  ///< of the last solve with S; 0 if it was factored

 private:
  SymmetricSolver reference_, direct_;
  Eigen::VectorXd diagonal_;  // of M0
  int iterations_ = 0;
};

}  // namespace tanktread::membrane
