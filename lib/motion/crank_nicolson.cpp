#include <algorithm>
#include <cmath>
#include <utility>

#include "base/errors.hpp"
#include "motion/schemes.hpp"

namespace tanktread::motion {

namespace {
constexpr double shrink = 0.75, grow = 1.33;
constexpr int most = 8, few = 4;      // sub-iterations
// largest number of NOX iterations per step; if they do not converge, halving the step is cheaper than more iterations
constexpr int most_accelerated = 40;
}  // namespace

CrankNicolson::CrankNicolson(const TimeOptions& options, const std::shared_ptr<Teuchos::ParameterList>& nox)
    : Scheme(options), by_error_(options.by_error()) {
  if (options.nonlinear_solver != "plain") solver_ = std::make_unique<coupling::FixedPoint>(options.nonlinear_solver, nox);
}

CrankNicolson::Iteration CrankNicolson::iterate(coupling::Dynamics& dynamics, const TimeState& state, double dt, const State& start) const {
  dynamics.set_time(state.time + dt, state.time);
  Iteration iteration{start};
  const State known = state.x + dt / 2 * state.history.front();
  const auto map = [&](const State& y) -> State {
    ++iteration.count;
    return known + dt / 2 * dynamics.velocity(y);
  };
  const double tolerance = by_error_ ? options_.newton_tolerance * options_.tolerance : options_.iteration_tolerance;
  if (solver_) {
    const auto norm = [&](const State& change) { return dynamics.norm(change); };
    iteration.converged = solver_->solve(map, norm, tolerance, most_accelerated, iteration.y).converged;
    return iteration;
  }
  iteration.count = options_.count_euler_step ? 1 : 0;
  while (iteration.count < most && !iteration.converged) {
    const State next = map(iteration.y);
    const double change = dynamics.norm(next - iteration.y);
    iteration.y = next;
    if (!std::isfinite(change)) break;
    iteration.converged = change <= tolerance;
  }
  return iteration;
}

StepReport CrankNicolson::advance(coupling::Dynamics& dynamics, TimeState& state, double limit) {
  begin(dynamics, state);
  Attempts attempts(options_, state, limit);
  // true if TimeState::memory contains two values of the last accepted step: its size, and its error divided by the tolerance
  const bool known = by_error_ && state.history.size() > 1;

  for (;;) {
    const double dt = attempts.next();
    const State& v = state.history.front();
    const double r = known ? dt / state.memory[0] : 0;
    const State explicitly = known ? State(state.x + dt / 2 * ((2 + r) * v - r * state.history[1])) : State(state.x + dt * v);
    auto [y, count, converged] = iterate(dynamics, state, dt, explicitly);
    attempts.report.iterations += count;
    if (!converged && options_.fixed_step)
      throw RunFailure("Crank-Nicolson with a fixed step did not converge: set a smaller Time/fixed step");
    const double error = known ? dynamics.norm(y - explicitly) / (3 * (1 + 1 / r)) / (options_.tolerance * step_share(options_.tolerance, 2)) : 0;
    State slope;
    if (converged && (error <= 1 || options_.fixed_step)) {
      dynamics.restore_constraints(y);
      slope = dynamics.velocity(y);
      converged = slope.allFinite();
      if (!converged && options_.fixed_step)
        throw RunFailure("Crank-Nicolson with a fixed step gave values that are not finite: set a smaller Time/fixed step");
    }
    if (slope.empty() || !converged) {
      attempts.reject(by_error_ ? (converged ? std::min(0.8, step_factor(error, 0, 3)) : 0.5) : shrink, by_error_ && converged ? error : 0);
      continue;
    }
    double factor = count < few ? grow : 1;
    if (by_error_) {
      factor = known ? step_factor(error, state.memory[1], 3) : 1;
      state.memory = {dt, error};
    }
    state.history.insert(state.history.begin(), std::move(slope));
    state.slope_error = 0;
    state.history.resize(by_error_ ? 2 : 1);
    return attempts.accept(dynamics, std::move(y), error, factor, step_share(options_.tolerance, 2));
  }
}

}  // namespace tanktread::motion
