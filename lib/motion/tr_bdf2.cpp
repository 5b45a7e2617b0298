#include <algorithm>
#include <cmath>
#include <utility>

#include "motion/quasi_newton.hpp"

namespace tanktread::motion {

namespace {
const double d = 1 - 1 / std::sqrt(2.0);
const double w = std::sqrt(2.0) / 4;
constexpr double accuracy = 4;  // error of the second-order result divided by that of the extrapolated one, at the least
}  // namespace

StepReport TrBdf2::advance(coupling::Dynamics& dynamics, State& state, double limit) {
  begin(dynamics, state);
  if (state.frozen.size() == 0) dynamics.freeze(state.frozen = state.x);
  const Memory memory = remembered<Memory>(state.memory);
  coupling::Secants secants = state.secants;
  Attempts attempts(options_, state, limit);

  for (;;) {
    const double dt = attempts.next(), shift = d * dt;
    const Net& k1 = state.history.front();
    std::vector<double> times{0, (2 * d - 1) * memory.step, -memory.step};  // of the slopes, from the start of this step
    std::vector<const Net*> slopes;
    for (const Net& slope : state.history) slopes.push_back(&slope);
    const auto predicted = [&](double time) {
      const std::size_t n = std::min<std::size_t>(slopes.size(), options_.predictor_order + 1);
      return interpolated(times, std::span(slopes).first(n), time);
    };

    Stage second, third;
    const Net rhs2 = state.x + shift * k1;
    second.y = rhs2 + shift * predicted(2 * d * dt);
    dynamics.improve_start(second.y, state.x, shift);
    dynamics.at(state.time + 2 * d * dt, state.time);
    solve(dynamics, options_, rhs2, shift, secants, second);
    const Net& k2 = second.slope;
    if (second.solved) {
      times.insert(times.begin(), 2 * d * dt);
      slopes.insert(slopes.begin(), &k2);
      const Net rhs3 = state.x + dt * w * (k1 + k2);
      third.rate = second.rate;
      third.y = rhs3 + shift * predicted(dt);
      dynamics.improve_start(third.y, second.y, shift);
      dynamics.at(state.time + dt, state.time);
      solve(dynamics, options_, rhs3, shift, secants, third);
    }
    attempts.report.iterations += second.iterations + third.iterations;
    double error = 0, slope_error = 0;
    if (third.solved) {
      const Net raw = dt * ((4 * w - 1) / 3 * k1 - k2 / 3 + 2 * d / 3 * third.slope);
      const Net once = dynamics.solve(shift, raw, options_.linear_tolerance, {}), twice = dynamics.solve(shift, once, options_.linear_tolerance, {});
      error = (dynamics.norm(once) / accuracy + second.error + third.error) / options_.tolerance;
      third.y -= twice;
      third.slope -= (twice - once) / shift;
      slope_error = (third.error + third.rate * dynamics.norm(twice)) / shift;
    }
    const auto [accepted, factor] = judge(dynamics, options_, state, secants, third, error, 3, memory);
    if (accepted) {
      state.history = {third.slope, k2, k1};
      state.secants = std::move(secants);
      state.memory = values_of(Memory{error, dt});
      state.slope_error = slope_error;
      return attempts.accept(dynamics, std::move(third.y), error, factor);
    }
    attempts.reject(std::min(factor, 0.8), error);
  }
}

}  // namespace tanktread::motion
