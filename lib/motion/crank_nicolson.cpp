#include "motion/crank_nicolson.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"

namespace tanktread::motion {

StepReport CrankNicolson::advance(coupling::Dynamics& dynamics, State& state, double limit) {
  constexpr double shrink = 0.75, grow = 1.33;
  constexpr int most = 8, few = 4;
  if (state.history.empty()) state.history = {dynamics.velocity(state.x)};
  StepReport report;
  double h = options_.fixed_step ? *options_.fixed_step : state.step;

  for (;; ++report.rejected) {
    refuse_tiny_step(h, state.time, limit, options_);
    const double dt = step_towards(state.time, limit, h);
    const Net& v0 = state.history.front();
    Net y = state.x + dt * v0, v = v0;
    int k = options_.count_euler_step ? 1 : 0;
    bool converged = false;
    while (k < most && !converged) {
      v = dynamics.velocity(y);
      const Net next = state.x + dt / 2 * (v0 + v);
      ++k;
      const double change = dynamics.norm(next - y);
      y = next;
      if (!std::isfinite(change)) break;
      converged = change <= options_.iteration_tolerance;
    }
    report.iterations += k;
    if (!converged) {
      if (options_.fixed_step) throw RunFailure("Crank-Nicolson with a fixed step did not converge within 8 sub-iterations");
      h = dt * shrink;
      continue;
    }
    dynamics.restore_volume(y);
    report.step = dt;
    report.displacement = dynamics.norm(y - state.x);
    state.x = y;
    state.history = {dynamics.velocity(y)};
    state.time = dt == limit - state.time ? limit : state.time + dt;
    state.step = std::min(k < few ? h * grow : h, options_.maximum_step.value_or(1e300));
    return report;
  }
}

}  // namespace tanktread::motion
