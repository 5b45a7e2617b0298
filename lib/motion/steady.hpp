#pragma once
// Shapes at rest.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "system/dynamics.hpp"
#include "system/solids/rigid_motion.hpp"
#include "system/solvers/options.hpp"

namespace tanktread::deck {
class Section;
}

namespace tanktread::motion {

/// `Steady/*` of the deck.
struct SteadyOptions {
  bool present = false;             ///< whether the deck has this list
  std::string method = "anderson";  ///< anderson, newton-krylov
  double tolerance = 1e-8;          ///< of the estimated error of the shape (4.32), in the norm of `Time/tolerance`
  int iterations = 100;             ///< most
  std::optional<double> step;       ///< of the implicit step that preconditions, in time; empty: chosen from the rates of flow and membranes

  void declare(deck::Section& section);
};

/// What a search came to.
struct SteadyReport {
  int iterations = 0;
  bool converged = false;
  double rest = 0;  ///< estimated error of the shape
};

/// What a shape x at rest obeys that x0 leads to: with Q the projection onto what leads from one such shape to others, the rigid motions about the
/// origin in `free` and what relabels the points of a surface (Dynamics::relabellings), and x_V what the volume makes of x,
///
///   G(x) = (1 - Q) v(x) + (x_V - x)/s - Q (x - x0)/s = 0                                                           (4.17)
class SteadyEquations {
 public:
  /// `step`: s. The motion outlives this.
  SteadyEquations(coupling::Dynamics& dynamics, std::vector<coupling::RigidMotion> free, double step, Net start);

  Net residual(const Net& x);                          ///< s G(x), not finite where it cannot be had. Collective
  Net precondition(const Net& x, const Net& r);  ///< (1 - s J)^{-1} r with the frozen Jacobian (4.3), linearised at x. Collective
  double unit_length() const;                          ///< of a displacement, in the norm of all its numbers, where it is 1 in that of the motion
  std::vector<Net> neutral(const Net& x);  ///< orthonormal fields that Q projects onto. Collective
  coupling::Dynamics& dynamics() { return dynamics_; }
  double step() const { return step_; }

  /// The same equations with another s.
  SteadyEquations with_step(double step) const { return {dynamics_, free_, step, start_}; }

 private:
  coupling::Dynamics& dynamics_;
  std::vector<coupling::RigidMotion> free_;
  double step_;
  Net start_;
};

/// Their solution as the fixed point of x + s (1 - s J)^{-1} G(x), by NOX: accelerated (`anderson`) or by Newton's method (`newton-krylov`). Shorter
/// steps come first where a whole one moves x by much. Where it does not converge x is the best that was found. Collective.
SteadyReport find_steady(SteadyEquations& equations, const SteadyOptions& options, const coupling::SolverOptions& solvers, Net& x);

}  // namespace tanktread::motion
