#pragma once
// One Belos solve on short replicated vectors with an operator of ours.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace Teuchos {
class ParameterList;
}

namespace tanktread::coupling {

/// What a linear solve did.
struct SolveReport {
  int iterations = 0;
  bool converged = false;
  std::vector<double> history;  ///< relative residual after each iteration; on the first rank, which is the one that speaks
};

/// Throws RunFailure with the residual history when `report` is of a solve of `system` that did not reach `tolerance`.
void require_convergence(const SolveReport& report, const std::string& system, double tolerance);

/// Belos, called through its factory, on short vectors that every rank holds whole (Vectors): every rank does the same arithmetic on the whole short
/// vector, which is the first rank's where it comes from outside, so dot products need no message and an iteration count cannot differ between
/// ranks. The operator may be distributed inside; it must return the same vector on every rank, but for round-off.
class Krylov {
 public:
  using Apply = std::function<void(const double* in, double* out)>;

  /// `solver` is a name of Belos' factory ("GMRES", "BICGSTAB", …); `list` goes to Belos as it is, after our defaults.
  /// Throws UserError for a name or a list that Belos does not know.
  Krylov(std::string solver, std::shared_ptr<Teuchos::ParameterList> list);
  ~Krylov();

  /// Solves apply(x) = b to the relative residual `tolerance`, relative to |b|, starting from x. Collective. Does not throw when it
  /// stops short, or breaks down, the solution then not a number; see the report. `precondition`: an approximate inverse of apply, from the right,
  /// so that residuals are those of the system.
  SolveReport solve(const Apply& apply, const Eigen::VectorXd& b, Eigen::VectorXd& x, double tolerance, const Apply& precondition = {}) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tanktread::coupling
