#pragma once
// Counts, times and other data of a run in addition to its state, and their storage in checkpoints.

#include <vector>

#include "record/files/checkpoint.hpp"
#include "record/files/summary.hpp"
#include "scene/particles/warnings.hpp"
#include "scene/series/phase_angle.hpp"
#include "stokes/kernels/kernels.hpp"
#include "system/capsule.hpp"
#include "system/contact.hpp"

namespace tanktread {

/// Totals of a run since its beginning, including earlier parts of a resumed run.
struct RunTotals {
  int step = 0;  ///< number of steps so far; `run.h5` has step + 1 rows, including the initial state
  double wall_seconds = 0;
  coupling::OperationCounts counts;
  int refinements = 0, coarsenings = 0;
  stokes::Evaluations kernel;       ///< kernel evaluations of all ranks
  Warnings::Memory warnings;
  std::vector<PhaseAngle> phase_angle;     ///< phase of each particle
  coupling::Contacts contacts;             ///< contacts that hold particles apart
  output::Entries<double> seconds;  ///< wall time of the first rank in each phase of the program
};

/// Calls act(name, kinds of particles, description, value) for the counters of kernel evaluations on all ranks, see each_count().
template <class Some, class Act>
void each_kernel_count(Some& kernel, const Act& act) {
  act("kernel_evaluations_far", "all", "number of evaluations of the Stokes kernels (2.1) on all ranks by far-field quadrature", kernel.far);
  act("kernel_evaluations_near", "all", "number of evaluations of the Stokes kernels on all ranks by near-singular quadrature", kernel.near);
  act("kernel_evaluations_self", "all",
      "number of evaluations of the Stokes kernels on all ranks by singular quadrature, on the element of the target", kernel.self);
}

/// Calls act(name, kinds of particles, description, value) for every counter of a run, for example the number of accepted steps. The counter is
/// reported only for these kinds of particles. Checkpoints and the summary store each counter under its name.
template <class Some, class Act>
void each_count(Some& totals, const Act& act) {
  constexpr const char* moving = "capsule, drop, free body";
  act("steps", moving, "number of accepted time steps", totals.step);
  act("refinements", moving, "number of mesh changes that refined elements", totals.refinements);
  act("coarsenings", moving, "number of mesh changes that merged elements", totals.coarsenings);
  act("evaluations", moving, "number of velocity evaluations (4.2)", totals.counts.evaluations);
  act("assemblies", moving, "number of times that the boundary-integral operator in the Jacobian was assembled (4.3)",
      totals.counts.assemblies);
  act("tangents", moving, "number of times that the tangent stiffness of the membrane was evaluated", totals.counts.tangents);
  act("linear_solves", moving, "number of linear systems solved in implicit time steps; for a free body, linear systems for its motion",
      totals.counts.solves);
  act("solver_iterations", "all",
      "number of iterations of the linear solver in `linear_solves`; for a prescribed body, in the solutions for its traction and the "
      "tractions of unit motions",
      totals.counts.solver_iterations);
  act("velocity_iterations", moving, "number of iterations of the linear solver for velocities", totals.counts.velocity_iterations);
  act("velocity_solves", moving, "number of linear systems solved for velocities", totals.counts.velocity_solves);
  act("most_velocity_iterations", moving, "largest number of iterations of one linear solve for a velocity",
      totals.counts.most_velocity_iterations);
  each_kernel_count(totals.kernel, act);
}

/// Returns every count of the run with its name, for the summary.
output::Entries<long> counts(const RunTotals& totals);

/// Adds all of `totals` to the checkpoint.
void store(const RunTotals& totals, output::Checkpoint& checkpoint);

/// Returns the totals stored in the checkpoint. Throws std::out_of_range if a part of them is missing.
RunTotals stored_totals(const output::Checkpoint& checkpoint);

}  // namespace tanktread
