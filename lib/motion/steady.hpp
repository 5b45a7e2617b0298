#pragma once
// Shapes at rest.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "coupling/dynamics.hpp"
#include "coupling/options.hpp"
#include "coupling/rigid_motion.hpp"

namespace tanktread::deck {
class Section;
}

namespace tanktread::motion {

/// `Steady/*` of the deck.
struct SteadyOptions {
  bool present = false;             ///< whether the deck has this list
  std::string method = "anderson";  ///< anderson, newton-krylov
  double tolerance = 1e-8;          ///< of the correction that is left, in the norm of `Time/tolerance`
  int iterations = 100;             ///< most
  std::optional<double> step;       ///< of the implicit step that preconditions, in time; empty: half of one over the rate of the scene

  void declare(deck::Section& section);
};

/// What a search came to.
struct SteadyReport {
  int iterations = 0;
  bool converged = false;
  double rest = 0;  ///< the correction that was left
};

/// The volume-keeping shape x, from the one x0 given on, that the motion leaves as it is, but for the rigid motions about the origin in `free`, which
/// lead from one such shape to others: with Q the projection onto them and x_V what the volume makes of x,
///
///   G(x) = (1 - Q) v(x) + (x_V - x)/s - Q (x - x0)/s = 0                                                           (4.17)
///
/// as the fixed point of x + s (1 - s J)^{-1} G(x), an implicit step s with the frozen Jacobian (4.3), by NOX: accelerated (`anderson`) or by Newton's
/// method (`newton-krylov`). Where it does not converge x is the best that was found. Collective.
SteadyReport find_steady(coupling::Dynamics& dynamics, const std::vector<coupling::RigidMotion>& free, const SteadyOptions& options,
                         const coupling::SolverOptions& solvers, Net& x);

}  // namespace tanktread::motion
