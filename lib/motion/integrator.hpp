#pragma once
// Interface of all time integrators.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "motion/options.hpp"
#include "system/dynamics.hpp"

namespace Teuchos {
class ParameterList;
}

namespace tanktread::motion {

using coupling::State;

/// State x at an earlier time.
struct PastPosition {
  double time = 0;
  State x;
};

/// Complete state of a time integration, part of a checkpoint. A run that continues from this state gives bitwise the results of an uninterrupted
/// run. A new member also needs a decision in: forget() and each_vector(); record/files/checkpoint.cpp (stored and read); `adapt` in
/// scene/particles/coupled_particles.cpp; `hold_centre` in scene/particles/drift.cpp; `advance_apart` in app/time_steps.cpp.
struct TimeState {
  double time = 0;
  double step = 0;              ///< the step that the controller proposes next
  State x;                      ///< shapes or pose, and fields
  std::vector<State> history;     ///< slopes dx/dt that the scheme keeps, latest first; the first is the slope at x
  std::vector<PastPosition> places;    ///< earlier positions that a multistep scheme keeps, latest first
  double slope_error = 0;       ///< error bound of the slope at x, history.front(), in the norm of `Time/tolerance` per unit of time
  State direction;              ///< last direction of the power iteration for the stiffness (4.7); absent if the stiffness was not measured
  std::vector<double> memory;   ///< memory of the step controller; each scheme defines its content
  coupling::Secants secants;    ///< secant pairs for the Jacobian, collected by the quasi-Newton iterations
  State frozen;                 ///< state at which the Jacobian's layer operators were assembled; absent if there are none
  double frozen_time = 0;       ///< time of the shape `frozen`
};

/// Keeps only the data that every scheme uses: position, slope, step, and the state `frozen` of the assembled layer operators. Used if the
/// state was computed by another scheme.
void forget(TimeState& state);

/// Calls `act` with each vector of the state, which it may change, and with a name of the vector.
void each_vector(TimeState& state, const std::function<void(const std::string& name, State& vector)>& act);

/// Computes the slope dx/dt at the state, if the state has no slope yet.
void begin(coupling::Dynamics& dynamics, TimeState& state);

/// Assembles the layer operators of the Jacobian at the state and its time, and stores both in TimeState::frozen and TimeState::frozen_time. If the
/// lattice changes in time, then sets the time of `dynamics` to `time`, which belongs to the step that begins at the time of the state.
void freeze(coupling::Dynamics& dynamics, TimeState& state, double time);
/// Assembles the layer operators of the Jacobian at TimeState::frozen and the time TimeState::frozen_time. Does nothing if TimeState::frozen is
/// absent. Sets the time of `dynamics` as freeze() does.
void refreeze(coupling::Dynamics& dynamics, const TimeState& state, double time);

/// Restarts the state and returns true if the motion is not smooth in time at the time of the state (a kink); otherwise returns false. The restart
/// keeps only position, step size and frozen layer operator, and computes the slope (velocity) after the kink. `advance` calls this function first.
/// Until then the state contains the slope before the kink.
bool cross_kink(coupling::Dynamics& dynamics, TimeState& state);

/// Report of one call of `advance`.
struct StepReport {
  double step = 0;        ///< size of the accepted step
  int iterations = 0;     ///< nonlinear iterations or sub-iterations, including the iterations of rejected attempts
  int rejected = 0;       ///< number of rejected attempts
  double error = 0;       ///< estimated local error in the norm of `Time/tolerance`; 0 if there is no estimate
  double displacement = 0;///< norm of x_{n+1} - x_n
};

/// Time integration scheme for dx/dt = v(x) with step size control.
class Integrator {
 public:
  virtual ~Integrator() = default;

  /// Advances by one accepted step, not beyond `limit` or the next kink of the motion. Throws RunFailure if the step falls below `Time/minimum step`.
  /// Time, position and slopes are then unchanged, unless cross_kink() has restarted the state.
  virtual StepReport advance(coupling::Dynamics& dynamics, TimeState& state, double limit) = 0;
};

/// Creates the scheme named by `Time/scheme`. `nox`: the parameter list `Solvers/NOX` of the deck.
std::unique_ptr<Integrator> integrator(const TimeOptions& options, const std::shared_ptr<Teuchos::ParameterList>& nox = nullptr);

/// Returns a first step for a state with known slope, at the cost of one velocity evaluation. The error of a second-order scheme, estimated from the
/// change of slope along a short Euler step (after Hairer, Norsett & Wanner, Solving ODEs I, II.4), is then about a tenth of the tolerance. With the
/// rate of the motion r = |dx/dt|, the third derivative is approximated by r max(|d2x/dt2|, r^2), so the step does not depend on the unit of time.
double first_step(coupling::Dynamics& dynamics, const TimeState& state, const TimeOptions& options);

/// Returns the size of the next step if the controller proposes `step`. Returns the remaining time up to `limit` if `step` reaches `limit`. Returns
/// half of the remaining time if two steps of this size reach `limit`, so that the last step is never tiny. Otherwise returns `step`.
double step_towards(double time, double limit, double step);

/// Continuous output within a step: the cubic Hermite interpolant of positions and slopes at both ends, of fourth order, without further evaluations.
class DenseOutput {
 public:
  /// `before`, `after`: states at the start and the end of the step. Both must have their slopes in history.front() and be on the same mesh.
  DenseOutput(const TimeState& before, const TimeState& after);

  State state(double time) const;
  State slope(double time) const;  ///< time derivative of state(), accurate to third order in the step

 private:
  double start_, step_;
  State x0_, x1_, v0_, v1_;
};

}  // namespace tanktread::motion
