#pragma once
// Linear systems of named blocks of unknowns, solved by Belos.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "system/solvers/options.hpp"

namespace tanktread::coupling {

/// Unknowns that belong together, as a velocity, a traction or a pressure drop.
struct UnknownBlock {
  std::string name;
  Eigen::Index size = 0;
  bool operator==(const UnknownBlock&) const = default;
};
using Blocks = std::vector<UnknownBlock>;

/// A linear map of all blocks, one after another, to all of them.
using Apply = std::function<void(const double* in, double* out)>;

/// A linear system. Its operators may be distributed inside; they must return the same numbers on every rank, but for round-off.
struct LinearSystem {
  Blocks blocks;
  Apply product;
  Apply precondition;  ///< an approximate inverse of the product, from the right, so that residuals are those of the system; or none
};

/// What a linear solve did.
struct SolveReport {
  int iterations = 0;
  bool converged = false;
  /// Of each block, over the norm of the right-hand side, where it did not converge.
  std::vector<std::pair<std::string, double>> residuals;
};

/// Throws RunFailure with the residuals when `report` is of a solve of `system` that did not reach `tolerance`.
void require_convergence(const SolveReport& report, const std::string& system, double tolerance);

/// One of Belos' solvers, with its list, through Thyra (thyra_blocks.hpp).
class Krylov {
 public:
  /// The names of solvers: those of Belos' factory.
  static std::vector<std::string> names();

  /// The solver is one of them ("GMRES", "BICGSTAB", …); its list goes to Belos as it is, after our defaults. Throws UserError for a name or a
  /// parameter that Belos does not know.
  explicit Krylov(const IterativeOptions& options);
  Krylov(const std::string& solver, const std::shared_ptr<Teuchos::ParameterList>& list) : Krylov(IterativeOptions{solver, list}) {}
  ~Krylov();

  /// Solves the system for the right-hand side b to the relative residual `tolerance`, relative to |b|, starting from x. Collective. Does not throw
  /// when it stops short, or breaks down, the solution then not a number; see the report.
  SolveReport solve(const LinearSystem& system, const Eigen::VectorXd& b, Eigen::VectorXd& x, double tolerance) const;

  /// Discards the products that the preconditioner `recycled` keeps from earlier solves. No checkpoint holds them.
  void forget() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace tanktread::coupling
