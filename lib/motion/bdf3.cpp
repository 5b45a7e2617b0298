#include <algorithm>
#include <array>
#include <utility>

#include "motion/quasi_newton.hpp"

namespace tanktread::motion {

namespace {

constexpr std::size_t places = 3;  // number of positions, earlier than the current one, that a step needs
constexpr double growth = 1.5;     // largest ratio of a step to the previous one
constexpr int patience = 3;        // number of failed attempts at a step after which the scheme starts again with TR-BDF2 steps

/// Coefficients of the backward differentiation (4.9) for a step of size dt: the shift gamma dt, by which the Jacobian is multiplied, and the weights
/// a_0, a_1, a_2 of the positions at times[0 … 2]. All times are relative to the start of the step.
struct Differentiation {
  double shift;
  std::array<double, places> a;
  Differentiation(const std::array<double, places + 1>& times, double dt) : shift(0), a{} {
    double sum = 0;
    for (size_t i = 0; i < places; ++i) {
      sum += 1 / (dt - times[i]);
      a[i] = 1 / (times[i] - dt);
      for (size_t j = 0; j < places; ++j)
        if (j != i) a[i] *= (dt - times[j]) / (times[i] - times[j]);
    }
    shift = 1 / sum;
  }
};

}  // namespace

/// Makes a starting step by TR-BDF2, and stores the position before this step for later BDF3 steps.
StepReport Bdf3::start(coupling::Dynamics& dynamics, TimeState& state, double limit) {
  PastPosition before{state.time, state.x};
  const StepReport report = starter_.advance(dynamics, state, limit);
  state.places.insert(state.places.begin(), std::move(before));
  if (state.places.size() == places) {
    state.history.resize(1);
    state.step = std::min(state.step, options_.fixed_step.value_or(growth * report.step));
  }
  return report;
}

StepReport Bdf3::advance(coupling::Dynamics& dynamics, TimeState& state, double limit) {
  if (state.places.size() < places) return start(dynamics, state, limit);
  if (state.frozen.empty()) freeze(dynamics, state, state.time);
  const Memory memory = remembered<Memory>(state.memory);
  coupling::Secants secants = state.secants;
  const std::array<const State*, places + 1> positions{&state.x, &state.places[0].x, &state.places[1].x, &state.places[2].x};
  std::array<double, places + 1> times{};
  for (size_t i = 0; i < places; ++i) times[i + 1] = state.places[i].time - state.time;
  const double allowed = options_.tolerance * step_share(options_.tolerance, 3);
  Attempts attempts(options_, state, limit);

  while (attempts.report.rejected < patience) {
    const double dt = attempts.next();
    const Differentiation scheme(times, dt);
    const State rhs = -scheme.shift * (scheme.a[0] * *positions[0] + scheme.a[1] * *positions[1] + scheme.a[2] * *positions[2]);
    const State predicted = interpolated(times, positions, dt);
    Stage stage;
    stage.time = state.time + dt;
    stage.y = predicted;
    dynamics.improve_start(stage.y, state.x, scheme.shift);
    dynamics.set_time(stage.time, state.time);
    solve(dynamics, options_, rhs, scheme.shift, secants, stage);
    attempts.report.iterations += stage.iterations;

    const double distance = stage.solved ? dynamics.norm(stage.y - predicted) : 0;
    const double error = scheme.shift / (dt - times[places]) * distance / allowed + stage.error / options_.tolerance;
    const Verdict verdict = judge(dynamics, options_, state, secants, stage, error, 4, memory);
    const double factor = std::min(growth, verdict.factor);
    if (verdict.accepted) {
      state.places.insert(state.places.begin(), {state.time, state.x});
      state.places.pop_back();
      state.memory = values_of(Memory{error, dt});
      state.history = {stage.slope};
      state.slope_error = stage.error / scheme.shift;
      state.secants = std::move(secants);
      const StepReport report = attempts.accept(dynamics, std::move(stage.y), error, factor, step_share(options_.tolerance, 3));
      state.step = std::min(state.step, growth * dt);
      return report;
    }
    attempts.reject(std::min(factor, 0.8), error);
  }

  TimeState fresh = state;
  fresh.history.resize(1);
  fresh.places.clear();
  fresh.memory.clear();
  fresh.step = attempts.next();
  StepReport report = start(dynamics, fresh, limit);
  state = std::move(fresh);
  report.rejected += attempts.report.rejected;
  report.iterations += attempts.report.iterations;
  return report;
}

}  // namespace tanktread::motion
