#include "motion/crank_nicolson.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/errors.hpp"

namespace tanktread::motion {

namespace {
constexpr double shrink = 0.75, grow = 1.33;
constexpr int most = 8, few = 4;      // sub-iterations
constexpr int most_accelerated = 40;  // a step that needs more is better halved
}  // namespace

CrankNicolson::CrankNicolson(const TimeOptions& options, const std::shared_ptr<Teuchos::ParameterList>& nox)
    : options_(options), by_error_(options.by_error()) {
  if (options.nonlinear_solver != "plain") solver_ = std::make_unique<coupling::FixedPoint>(options.nonlinear_solver, nox);
}

/// From the start of the iteration in attempt.y.
void CrankNicolson::iterate(coupling::Dynamics& dynamics, const State& state, double dt, Attempt& attempt) const {
  dynamics.at(state.time + dt, state.time);
  const Net known = state.x + dt / 2 * state.history.front();
  const auto map = [&](const Net& y) -> Net {
    ++attempt.iterations;
    return known + dt / 2 * dynamics.velocity(y);
  };
  const double tolerance = by_error_ ? options_.newton_tolerance * options_.tolerance : options_.iteration_tolerance;
  if (solver_) {
    const auto norm = [&](const Net& change) { return dynamics.norm(change); };
    attempt.converged = solver_->solve(map, norm, tolerance, most_accelerated, attempt.y).converged;
    return;
  }
  attempt.iterations = options_.count_euler_step ? 1 : 0;
  while (attempt.iterations < most && !attempt.converged) {
    const Net next = map(attempt.y);
    const double change = dynamics.norm(next - attempt.y);
    attempt.y = next;
    if (!std::isfinite(change)) return;
    attempt.converged = change <= tolerance;
  }
}

StepReport CrankNicolson::advance(coupling::Dynamics& dynamics, State& state, double limit) {
  begin(dynamics, state);
  StepReport report;
  double h = options_.fixed_step ? *options_.fixed_step : state.step;
  const bool known = by_error_ && state.history.size() > 1;  // State::memory: the last step and its error over the tolerance

  for (;; ++report.rejected) {
    refuse_tiny_step(h, state.time, limit, options_);
    const double dt = step_towards(state.time, limit, h);
    const Net& v = state.history.front();
    const double r = known ? dt / state.memory[0] : 0;
    const Net explicitly = known ? Net(state.x + dt / 2 * ((2 + r) * v - r * state.history[1])) : Net(state.x + dt * v);
    Attempt attempt;
    attempt.y = explicitly;
    iterate(dynamics, state, dt, attempt);
    report.iterations += attempt.iterations;
    if (!attempt.converged && options_.fixed_step) throw RunFailure("Crank-Nicolson with a fixed step did not converge");
    const double error = known ? dynamics.norm(attempt.y - explicitly) / (3 * (1 + 1 / r)) / options_.tolerance : 0;
    Net y = attempt.y, slope;
    if (attempt.converged && (error <= 1 || options_.fixed_step)) {
      dynamics.restore_volume(y);
      slope = dynamics.velocity(y);
      attempt.converged = slope.allFinite();
      if (!attempt.converged && options_.fixed_step) throw RunFailure("Crank-Nicolson with a fixed step ended in numbers that are not finite");
    }
    if (slope.size() == 0 || !attempt.converged) {
      h = dt * (by_error_ ? (attempt.converged ? std::min(0.8, step_factor(error, 0, 3)) : 0.5) : shrink);
      continue;
    }
    report.step = dt;
    report.error = error * options_.tolerance;
    report.displacement = dynamics.norm(y - state.x);
    double next = attempt.iterations < few ? std::max(h, dt * grow) : h;  // a step cut short at a limit tells little of a whole one
    if (by_error_) {
      const double factor = known ? step_factor(error, state.memory[1], 3) : 1;
      next = dt < h ? std::max(h, dt * factor) : dt * factor;
      state.memory = {dt, error};
    }
    state.x = std::move(y);
    state.history.insert(state.history.begin(), std::move(slope));
    state.history.resize(by_error_ ? 2 : 1);
    state.time = dt == limit - state.time ? limit : state.time + dt;
    state.step = std::min(next, options_.maximum_step.value_or(1e300));
    return report;
  }
}

}  // namespace tanktread::motion
