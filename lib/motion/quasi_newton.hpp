#pragma once
// Solution of the stages of implicit schemes: quasi-Newton iteration, measurement of the iteration error, and acceptance of steps.

#include <span>

#include "motion/schemes.hpp"

namespace tanktread::motion {

/// Memory of the step controller between steps, stored at the front of TimeState::memory.
struct Memory {
  double error = 0;  ///< local error of the last accepted step divided by the tolerance; 0 before the first step
  double step = 0;   ///< size of the last accepted step
};

/// Stage of an implicit scheme, y - shift v(y) = rhs with the velocity v, and its solution.
struct Stage {
  double time = 0;      ///< time at which the velocity v is evaluated; used only by `judge`
  State y;                ///< start value of the iteration, and after `solve` the solution
  State slope;            ///< slope (y - rhs)/shift of the result
  double rate = 0;      ///< contraction rate observed in this step, by this stage or an earlier stage; 0 if none was observed yet
  double error = 0;     ///< upper bound of the distance of the result from the exact solution of the stage, in the norm of `Time/tolerance`
  int iterations = 0;   ///< number of evaluations of the defect
  bool solved = false;

  double rate_or_assumed() const { return rate > 0 ? rate : 0.5; }
};

/// Solves a stage by quasi-Newton iteration. The approximate Jacobian is the frozen-geometry Jacobian (4.3), improved by the secants (4.13); its
/// membrane tangent H is updated in every iteration. A second iteration adds one pair to the secants. With d_k the correction of iteration k,
///
///   rate = |d_k|/|d_(k-1)|,   error = rate/(1 - rate) |d_k|                                                                       (4.28)
///
/// The iteration ends if the error is below `Time/newton tolerance` times the tolerance. If an earlier stage of the same step has observed a rate,
/// this rate is used from the first iteration on, because the stages have the same frozen Jacobian and shift. Otherwise the first rate is assumed
/// to be 1/2, and the error must be ten times smaller, so that a second evaluation is made unless the first correction is very small. Errors of
/// stages that end after one evaluation point the same way in all steps and add up: they were four fifths of the error of four red cells in a tube.
/// The rate is never taken below the relative residual of the linear solves.
void solve(coupling::Dynamics& dynamics, const TimeOptions& options, const State& rhs, double shift, coupling::Secants& secants, Stage& stage);

/// Decision on an attempted step.
struct Verdict {
  bool accepted = false;
  double factor = 0.5;  ///< size of the next attempt divided by the size of this attempt
};

/// Decides on an attempted step that ended with the stage `last`. `error`: local error of the step divided by the tolerance; it is proportional to
/// the step size to the power `power`. Restores the volume at the end of an accepted step; if this fails, the step is rejected. If the iteration
/// failed or contracted too slowly, and the shape has changed since the layer operators were last assembled, assembles them again at state.x and
/// deletes the secants. Throws RunFailure if a step of fixed size was not solved or its volume not restored.
Verdict judge(coupling::Dynamics& dynamics, const TimeOptions& options, TimeState& state, coupling::Secants& secants, Stage& last, double error,
              int power, const Memory& memory);

/// Returns the value at t of the polynomial through states[i] at times[i].
State interpolated(std::span<const double> times, std::span<const State* const> states, double t);

}  // namespace tanktread::motion
