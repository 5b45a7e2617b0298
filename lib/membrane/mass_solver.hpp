#pragma once
// Linear systems with the mass matrices of a moving surface.

#include <span>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "membrane/symmetric_solver.hpp"

namespace tanktread::membrane {

/// Solves systems with the mass matrix M0 of the unstressed surface (3.7) and with the mass matrix S of any later configuration (3.6). Amesos2
/// factors M0 once per mesh. Systems with S are solved by conjugate gradients. Their preconditioner D M0 D, with the diagonal matrix
/// D_A^2 = S_AA/M0_AA, has the diagonal of S. This preconditioner differs from S only because the stretch varies over the support of a basis
/// function. A few iterations therefore suffice, at a tenth of the cost of a factorisation. If the iterations do not converge, S is factored. The
/// result depends only on S, not on earlier configurations. For symmetric surfaces and fields, only the unknowns of the fundamental domain are solved
/// for.
class MassSolver {
 public:
  explicit MassSolver(const DirectSolverOptions& options = {}, const surface::Symmetry& symmetry = surface::Symmetry());

  /// Factors the mass matrix M0 of the unstressed surface. Throws as DirectSolver does.
  void factor(const Eigen::SparseMatrix<double>& m0);

  /// Returns the solver for M0.
  const SymmetricSolver& reference() const { return reference_; }

  /// Returns M0^-1 d, shape (N, 3), with M0 the mass matrix of the unstressed surface.
  Net solve(const Net& d) const { return reference_.solve(d); }

  /// Returns S^-1 d for the mass matrix S = s (3.6), to a relative residual of 1e-13 in each component.
  Net solve(const Eigen::SparseMatrix<double>& s, const Net& d);

  /// Returns S^-1 d for a scalar field d, shape (N), to a relative residual of 1e-13. Only for a solver without symmetry.
  Eigen::VectorXd solve_scalar(const Eigen::SparseMatrix<double>& s, const Eigen::VectorXd& d);

  int iterations() const { return iterations_; }  ///< iterations of the last solve with a mass matrix S (3.6); 0 if S was factored

 private:
  Net solve(const Eigen::SparseMatrix<double>& s, const Net& d, std::span<const int> components);

  SymmetricSolver reference_, direct_;
  Eigen::VectorXd diagonal_;  // diagonal of M0
  int iterations_ = 0;
};

}  // namespace tanktread::membrane
