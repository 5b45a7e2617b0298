#include "motion/bdf3.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "motion/quasi_newton.hpp"

namespace tanktread::motion {

namespace {

constexpr std::size_t places = 3;         // earlier ones that a step needs, x_n not counted
constexpr double growth = 1.5;    // of a step, at most
constexpr int patience = 3;       // attempts before the places are given up
constexpr double sharper = 1.86;  // shift over step, against TR-BDF2's

/// Value at t of the polynomial through (times[i], nets[i]).
Net interpolated(const std::array<double, places + 1>& times, const std::array<const Net*, places + 1>& nets, double t) {
  Net sum = Net::Zero(nets[0]->rows(), 3);
  for (size_t i = 0; i < times.size(); ++i) {
    double weight = 1;
    for (size_t j = 0; j < times.size(); ++j)
      if (j != i) weight *= (t - times[j]) / (times[i] - times[j]);
    sum += weight * *nets[i];
  }
  return sum;
}

/// (4.9) at the end dt of the step: 1/shift and a_0, a_1, a_2 for places at times[0 … 2].
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

/// A step of TR-BDF2, after which there is one place more.
StepReport Bdf3::start(coupling::Dynamics& dynamics, State& state, double limit) {
  Place before{state.time, state.x};
  const StepReport report = starter_.advance(dynamics, state, limit);
  state.places.insert(state.places.begin(), std::move(before));
  if (state.places.size() == places) {
    state.history.resize(1);
    state.memory[0] = std::min(0.9, sharper * state.memory[0]);
    state.step = std::min(state.step, options_.fixed_step.value_or(growth * report.step));
  }
  return report;
}

StepReport Bdf3::advance(coupling::Dynamics& dynamics, State& state, double limit) {
  if (state.places.size() < places) return start(dynamics, state, limit);
  if (state.frozen.size() == 0) dynamics.freeze(state.frozen = state.x);
  Memory memory = Memory::from(state.memory);
  coupling::Secants secants = state.secants;
  const std::array<const Net*, places + 1> nets{&state.x, &state.places[0].x, &state.places[1].x, &state.places[2].x};
  std::array<double, places + 1> times{};
  for (size_t i = 0; i < places; ++i) times[i + 1] = state.places[i].time - state.time;
  StepReport report;
  double h = options_.fixed_step ? *options_.fixed_step : state.step;

  for (;; ++report.rejected) {
    refuse_tiny_step(h, state.time, limit, options_);
    if (report.rejected >= patience) {
      State fresh = state;
      fresh.history.resize(1);
      fresh.places.clear();
      fresh.memory.clear();
      fresh.step = h;
      StepReport restarted = start(dynamics, fresh, limit);
      state = std::move(fresh);
      restarted.rejected += report.rejected;
      restarted.iterations += report.iterations;
      return restarted;
    }
    const double dt = step_towards(state.time, limit, h);
    const Differentiation scheme(times, dt);
    const Net rhs = -scheme.shift * (scheme.a[0] * *nets[0] + scheme.a[1] * *nets[1] + scheme.a[2] * *nets[2]);
    const Net predicted = interpolated(times, nets, dt);
    Stage stage;
    stage.y = predicted;
    stage.contraction = memory.expected_contraction(dt);
    dynamics.at(state.time + dt, state.time);
    solve(dynamics, options_, rhs, scheme.shift, secants, stage);
    report.iterations += stage.iterations;

    const double error =
        stage.solved ? scheme.shift / (dt - times[places]) * dynamics.norm(stage.y - predicted) / options_.tolerance : 0;
    const Verdict verdict = judge(dynamics, options_, state, stage, error, 4, memory);
    const double factor = std::min(growth, verdict.factor);
    Place before{state.time, state.x};
    if (!verdict.accepted || !accept(dynamics, options_, state, stage, dt, h, limit, error, factor, report)) {
      h = dt * std::min(factor, 0.8);
      continue;
    }

    state.step = std::min(state.step, growth * dt);
    state.memory = Memory{stage.contraction, error, dt}.values();
    state.history = {stage.slope};
    state.places.pop_back();
    state.places.insert(state.places.begin(), std::move(before));
    state.secants = std::move(secants);
    return report;
  }
}

}  // namespace tanktread::motion
