#pragma once
// Linear systems of named blocks of unknowns, solved by Belos.

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "base/types.hpp"
#include "system/blocks/layout.hpp"
#include "system/solvers/options.hpp"

namespace tanktread::coupling {

/// Returns one block of n unknowns.
inline std::vector<Block> one_block(std::string name, Eigen::Index n) { return {{.name = std::move(name), .rows = n, .components = 1}}; }

/// A linear map on the unknowns of all blocks, stored one block after another.
using Apply = std::function<void(const double* in, double* out)>;

/// Returns `map`, a linear map of nets of n rows, as a map of their components.
inline Apply on_nets(Eigen::Index n, std::function<Net(const Net&)> map) {
  return [n, map = std::move(map)](const double* in, double* out) { Eigen::Map<Net>(out, n, 3) = map(Eigen::Map<const Net>(in, n, 3)); };
}

/// A linear system. Its operators may be distributed internally, but must return equal values on every rank, up to round-off.
struct LinearSystem {
  std::vector<Block> blocks;
  Apply product;
  Apply precondition;  ///< optional: approximate inverse of `product`; applied from the right, so that residuals refer to the unpreconditioned system
};

/// Result of a linear solve.
struct SolveReport {
  int iterations = 0;
  bool converged = false;
  /// Residual of each block divided by the norm of the right-hand side, if the solve did not converge.
  std::vector<std::pair<std::string, double>> residuals;
};

/// Throws RunFailure with the residuals if the solve did not converge (`report.converged` is false). `tolerance`: tolerance that was not reached.
/// `system`: name of the system in the message.
void require_convergence(const SolveReport& report, const std::string& system, double tolerance);

/// A Belos solver with its parameter list, on Tpetra vectors (vectors.hpp).
class Krylov {
 public:
  /// Returns the names of the available solvers: the names of Belos' factory.
  static std::vector<std::string> names();

  /// Constructs the Belos solver named in the options ("GMRES", "BICGSTAB", …). The parameter list of the options is passed to Belos unchanged and
  /// overrides the defaults set here. Throws UserError if Belos does not know the name or a parameter.
  explicit Krylov(const IterativeOptions& options);
  ~Krylov();

  /// Solves the system for the right-hand side b to the residual `tolerance` relative to |b|, with initial guess x. Collective. Does not throw if the
  /// solver stops early or breaks down (x is NaN after a breakdown); check the report.
  SolveReport solve(const LinearSystem& system, const Eigen::VectorXd& b, Eigen::VectorXd& x, double tolerance) const;

  bool flexible() const;                 ///< whether the solver admits preconditioners that are not linear
  bool uses_own_preconditioner() const;  ///< whether the solver uses the preconditioner that a LinearSystem contains

  /// Discards the products that preconditioners of the type `recycled` have stored in earlier solves, in all objects of this class. A run calls this
  /// function after each checkpoint, because checkpoints do not contain these products.
  static void forget_recycled() { ++generation_; }

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
  inline static long generation_ = 0;  // number of calls of forget_recycled()
};

}  // namespace tanktread::coupling
