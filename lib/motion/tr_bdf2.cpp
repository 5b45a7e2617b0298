#include "motion/tr_bdf2.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "motion/quasi_newton.hpp"
#include "motion/slopes.hpp"

namespace tanktread::motion {

namespace {
const double d = 1 - 1 / std::sqrt(2.0);
const double w = std::sqrt(2.0) / 4;
}  // namespace

StepReport TrBdf2::advance(coupling::Dynamics& dynamics, State& state, double limit) {
  begin(dynamics, state);
  if (state.frozen.size() == 0) dynamics.freeze(state.frozen = state.x);
  Memory memory = Memory::from(state.memory);
  coupling::Secants secants = state.secants;
  StepReport report;
  double h = options_.fixed_step ? *options_.fixed_step : state.step;

  for (;; ++report.rejected) {
    refuse_tiny_step(h, state.time, limit, options_);
    const double dt = step_towards(state.time, limit, h), shift = d * dt;
    Slopes slopes(state.history, memory.step);
    const Net& k1 = state.history.front();
    Stage second, third;
    second.contraction = memory.expected_contraction(dt);

    const Net rhs2 = state.x + shift * k1;
    second.y = rhs2 + shift * slopes.at(2 * d * dt, options_.predictor_order);
    dynamics.at(state.time + 2 * d * dt, state.time);
    solve(dynamics, options_, rhs2, shift, secants, second);
    const Net& k2 = second.slope;
    third.contraction = second.contraction;
    double error = 0;
    if (second.solved) {
      slopes.add(2 * d * dt, k2);
      const Net rhs3 = state.x + dt * w * (k1 + k2);
      third.y = rhs3 + shift * slopes.at(dt, options_.predictor_order);
      dynamics.at(state.time + dt, state.time);
      solve(dynamics, options_, rhs3, shift, secants, third);
    }
    report.iterations += second.iterations + third.iterations;
    if (third.solved) {
      const Net raw = dt * ((4 * w - 1) / 3 * k1 - k2 / 3 + 2 * d / 3 * third.slope);
      error = dynamics.norm(dynamics.solve(shift, raw, options_.linear_tolerance, secants)) / options_.tolerance;
    }
    const auto [accepted, factor] = judge(dynamics, options_, state, third, error, 3, memory);
    if (!accepted || !accept(dynamics, options_, state, third, dt, h, limit, error, factor, report)) {
      h = dt * std::min(factor, 0.8);
      continue;
    }

    state.history = {third.slope, k2, k1};
    state.secants = std::move(secants);
    state.memory = Memory{third.contraction, error, dt}.values();
    return report;
  }
}

}  // namespace tanktread::motion
