#pragma once
// What the implicit schemes share: the stage equation, its quasi-Newton iteration and the memory of how fast that contracts.

#include <span>

#include "motion/schemes.hpp"

namespace tanktread::motion {

/// The controller's memory as it stands in front of State::memory.
struct Memory {
  double contraction = 0.3;  ///< contraction rate of the quasi-Newton iteration at the step `step`
  double error = 0;          ///< local error of the last accepted step over the tolerance; 0 before the first
  double step = 0;           ///< its size
  double least = 0;          ///< contraction rate below which none is expected: of the step whose first attempt erred too much

  /// The contraction rate to expect of a step dt: the part left out of (4.3) grows with the step. What the linear solves leave does not, so that a
  /// step that errs too much is not tried again shorter and shorter with a single iteration, whose rate is never seen.
  double expected_contraction(double dt) const;
};

/// A stage y - shift v(y) = rhs and what its solution came to.
struct Stage {
  Net y;                   ///< the start of the iteration, then its end
  Net slope;               ///< (y - rhs)/shift, algebraic
  double contraction = 0;  ///< expected rate, then the one found
  int iterations = 0;      ///< velocity evaluations
  bool solved = false;
};

/// Quasi-Newton iteration on the frozen-geometry Jacobian (4.3), H fresh in every iteration, to `Time/newton tolerance`.
/// Uses the secants (4.13) and adds its own.
void solve(coupling::Dynamics& dynamics, const TimeOptions& options, const Net& rhs, double shift, coupling::Secants& secants, Stage& stage);

/// What an attempt at a step comes to.
struct Verdict {
  bool accepted = false;
  double factor = 0.5;  ///< the next step over this one
};

/// After an attempt that ended with the stage `last` and the local error `error`, over the tolerance, of a scheme whose error falls with this
/// power of the step. Restores the volume of an accepted end, and accepts none of which that fails. Assembles the layer operator anew at state.x
/// where the iteration failed or contracted too slowly and the shape has moved on since the last time. Throws RunFailure when a step of fixed size
/// was not solved.
Verdict judge(coupling::Dynamics& dynamics, const TimeOptions& options, State& state, Stage& last, double error, int power, Memory& memory);

/// The value at t of the polynomial through nets[i] at times[i].
Net interpolated(std::span<const double> times, std::span<const Net* const> nets, double t);

}  // namespace tanktread::motion
