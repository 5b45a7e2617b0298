#include "motion/bs3.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"

namespace tanktread::motion {

StepReport Bs3::advance(coupling::Dynamics& dynamics, State& state, double limit) {
  begin(dynamics, state);
  StepReport report;
  double h = options_.fixed_step ? *options_.fixed_step : state.step;

  for (;; ++report.rejected) {
    refuse_tiny_step(h, state.time, limit, options_);
    const double dt = step_towards(state.time, limit, h);
    const Net& k1 = state.history.front();
    const auto slope = [&](double part, const Net& x) {
      dynamics.at(state.time + part * dt, state.time);
      return dynamics.velocity(x);
    };
    const Net k2 = slope(0.5, state.x + dt / 2 * k1);
    const Net k3 = slope(0.75, state.x + 3 * dt / 4 * k2);
    Net y = state.x + dt * (2. / 9 * k1 + 1. / 3 * k2 + 4. / 9 * k3);
    dynamics.restore_volume(y);
    const Net k4 = slope(1, y);
    report.iterations += 3;

    const double error = dynamics.norm(dt * (-5. / 72 * k1 + 1. / 12 * k2 + 1. / 9 * k3 - 1. / 8 * k4)) / options_.tolerance;
    const bool finite = std::isfinite(error);
    if (!finite && options_.fixed_step) throw RunFailure("the explicit step of fixed size ended in numbers that are not finite");
    const double factor = finite ? std::clamp(0.9 * std::pow(std::max(error, 1e-6), -1. / 3), 0.3, 2.0) : 0.3;
    if (!finite || (error > 1 && !options_.fixed_step)) {
      h = dt * std::min(factor, 0.9);
      continue;
    }
    report.step = dt;
    report.error = error * options_.tolerance;
    report.displacement = dynamics.norm(y - state.x);
    state.x = y;
    state.history = {k4};
    state.time = dt == limit - state.time ? limit : state.time + dt;
    state.step = std::min(dt < h ? std::max(h, dt * factor) : dt * factor, options_.maximum_step.value_or(1e300));
    return report;
  }
}

}  // namespace tanktread::motion
