#pragma once
// One small interface for every time integrator.

#include <memory>
#include <vector>

#include "base/types.hpp"
#include "motion/options.hpp"
#include "system/dynamics.hpp"

namespace Teuchos {
class ParameterList;
}

namespace tanktread::motion {

/// Where x was at an earlier time.
struct Place {
  double time = 0;
  Net x;
};

/// Everything that a run needs to go on from here to the last bit: it belongs to a checkpoint.
struct State {
  double time = 0;
  double step = 0;              ///< the step that the controller proposes next
  Net x;                        ///< control net
  std::vector<Net> history;     ///< slopes dx/dt that the scheme keeps, the latest first: the first one is that at x
  std::vector<Place> places;    ///< earlier places that a multistep scheme keeps, the latest first
  double slope_error = 0;       ///< bound of the error of the first slope, in the norm of `Time/tolerance` per unit of time
  Net direction;                ///< in which the stiffness (4.7) was found; empty where it was not sought
  std::vector<double> memory;   ///< the controller's memory, its meaning is the scheme's own
  coupling::Secants secants;    ///< what the quasi-Newton iterations have learnt of the Jacobian
  Net frozen;                   ///< control net on which the Jacobian's layer operators were assembled; empty if none were
};

/// Leaves what every scheme understands: place, slope, step and frozen operator. For the state that another scheme made.
void forget(State& state);

/// The first slope of a state that has none.
void begin(coupling::Dynamics& dynamics, State& state);

/// Where the state is at a kink of the motion, leaves place, step and frozen operator, with the slope that the motion goes on with; whether it is
/// there. `advance` does it by itself; until then the state has the slope with which its last step ended.
bool cross_kink(coupling::Dynamics& dynamics, State& state);

/// What one call of `advance` did.
struct StepReport {
  double step = 0;        ///< size of the accepted step
  int iterations = 0;     ///< nonlinear iterations or sub-iterations, rejected attempts included
  int rejected = 0;       ///< attempts given up
  double error = 0;       ///< estimated local error in the norm of `Time/tolerance` (0 where there is no estimate)
  double displacement = 0;///< norm of x_{n+1} - x_n
};

/// A scheme for dx/dt = v(x) with step control.
class Integrator {
 public:
  virtual ~Integrator() = default;

  /// One accepted step, not beyond `limit` nor the next kink of the motion. Throws RunFailure when the step falls below the minimum; the state is
  /// then unchanged, but for what cross_kink does.
  virtual StepReport advance(coupling::Dynamics& dynamics, State& state, double limit) = 0;
};

/// The scheme named by `Time/scheme`. `nox`: the deck's list `Solvers/NOX`.
std::unique_ptr<Integrator> integrator(const TimeOptions& options, const std::shared_ptr<Teuchos::ParameterList>& nox = nullptr);

/// A first step for a state whose slope is known, at the cost of one velocity evaluation: the error of a second-order scheme, judged by the
/// change of slope along a short Euler step (after Hairer, Norsett & Wanner, Solving ODEs I, II.4), is about a tenth of the tolerance. The third
/// derivative is taken for the rate of the motion times the second, or times its own square: whatever the unit of time, it is the same step.
double first_step(coupling::Dynamics& dynamics, const State& state, const TimeOptions& options);

/// The step to take towards `limit` when the controller proposes `step`: the whole rest if it fits, half of it if two are needed,
/// so that no sliver is left over.
double step_towards(double time, double limit, double step);

/// The motion within a step: the cubic that has the places and slopes of both ends (Hermite), fourth order in the step at no evaluation.
class DenseOutput {
 public:
  /// Both states with their slopes in history.front(), on one mesh, `after` later than `before`.
  DenseOutput(const State& before, const State& after);

  Net place(double time) const;
  Net slope(double time) const;  ///< the derivative of `place`, third order

 private:
  double start_, step_;
  Net x0_, x1_, v0_, v1_;
};

}  // namespace tanktread::motion
