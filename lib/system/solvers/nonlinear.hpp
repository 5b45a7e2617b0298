#pragma once
// Nonlinear systems, solved by NOX on short replicated vectors.

#include <algorithm>
#include <functional>
#include <memory>
#include <string>

#include "deck/forward.hpp"
#include "system/blocks/block_vector.hpp"
#include "system/solvers/options.hpp"

namespace tanktread::coupling {

/// Result of a nonlinear solve.
struct NonlinearReport {
  int iterations = 0;
  bool converged = false;
};

/// Solves a fixed-point problem x = g(x) by NOX. Every rank performs the same arithmetic on the complete short vector, so that iteration counts
/// cannot differ between ranks. g may be distributed internally and must return the same state on every rank.
class FixedPoint {
 public:
  using Map = std::function<State(const State&)>;
  using Norm = std::function<double(const State&)>;
  /// Returns the number of iterates that Anderson's method should combine in searches for a steady shape with `size` unknowns. With 4 iterates, the
  /// method does not converge near a fold or for travelling waves; with 20, it does not converge on fine meshes. 40 iterates are linearly dependent
  /// on coarse meshes.
  static int deep(Eigen::Index size) { return std::clamp(static_cast<int>(size / 64), 20, 40); }

  /// `method`: `anderson` (Anderson 1965; Walker & Ni 2011) or matrix-free `newton-krylov`. `linear`: Belos solver and preconditioner of the linear
  /// systems of `newton-krylov`, in which products with dg/dx are finite differences of g; the preconditioner "own" means none. `list` is passed to
  /// NOX unchanged and overrides the defaults set here. `depth`: number of iterates that `anderson` combines, if the list does not set it.
  FixedPoint(std::string method, const std::shared_ptr<Teuchos::ParameterList>& list, const IterativeOptions& linear = {"GMRES"}, int depth = 4);
  ~FixedPoint();

  /// Iterates from x until residual_norm(g(x) - x) <= tolerance or until `most` iterations have been made. `norm`: norm that scales the unknowns and
  /// the steps of finite differences. `residual_norm`: norm of the convergence test; `norm` if not given. A value of g that is not finite ends the
  /// iteration. Throws UserError if NOX rejects its parameter list. Collective.
  NonlinearReport solve(const Map& g, const Norm& norm, double tolerance, int most, State& x, const Norm& residual_norm = {}) const;

  /// Returns the path of a parameter of the given list that the last solve did not use; empty if all were used.
  std::string unread() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tanktread::coupling
