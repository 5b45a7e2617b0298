#include "motion/bdf3.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "motion/quasi_newton.hpp"

namespace tanktread::motion {

namespace {

constexpr int places = 3;         // earlier ones that a step needs, x_n not counted
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
    for (int i = 0; i < places; ++i) {
      sum += 1 / (dt - times[i]);
      a[i] = 1 / (times[i] - dt);
      for (int j = 0; j < places; ++j)
        if (j != i) a[i] *= (dt - times[j]) / (times[i] - times[j]);
    }
    shift = 1 / sum;
  }
};

}  // namespace

/// State::history holds TR-BDF2's slopes and then the earlier places; State::memory its three numbers and then the steps between the places.
StepReport Bdf3::start(coupling::Dynamics& dynamics, State& state, double limit) {
  const size_t known = state.memory.size() > 3 ? state.memory.size() - 3 : 0;
  std::vector<Net> earlier(state.history.end() - static_cast<std::ptrdiff_t>(known), state.history.end());
  std::vector<double> steps(state.memory.end() - static_cast<std::ptrdiff_t>(known), state.memory.end());
  State inner = state;
  inner.history.resize(state.history.size() - known);
  inner.memory.resize(state.memory.size() - known);
  const StepReport report = starter_.advance(dynamics, inner, limit);

  earlier.insert(earlier.begin(), state.x);
  steps.insert(steps.begin(), report.step);
  state = std::move(inner);
  if (earlier.size() == places) {
    state.history.resize(1);
    state.memory[0] = std::min(0.9, sharper * state.memory[0]);
    state.step = std::min(state.step, options_.fixed_step.value_or(growth * report.step));
  }
  state.history.insert(state.history.end(), earlier.begin(), earlier.end());
  state.memory.insert(state.memory.end(), steps.begin(), steps.end());
  return report;
}

StepReport Bdf3::advance(coupling::Dynamics& dynamics, State& state, double limit) {
  if (state.memory.size() < 3 + places) return start(dynamics, state, limit);
  if (state.frozen.size() == 0) dynamics.freeze(state.frozen = state.x);
  Memory memory = Memory::from(state.memory);
  coupling::Secants secants = state.secants;
  const std::array<const Net*, places + 1> nets{&state.x, &state.history[1], &state.history[2], &state.history[3]};
  std::array<double, places + 1> times{};
  for (int i = 0; i < places; ++i) times[i + 1] = times[i] - state.memory[3 + i];
  StepReport report;
  double h = options_.fixed_step ? *options_.fixed_step : state.step;

  for (;; ++report.rejected) {
    refuse_tiny_step(h, state.time, limit, options_);
    if (report.rejected >= patience) {
      State fresh = state;
      fresh.history.resize(1);
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
    if (!verdict.accepted) {
      h = dt * std::min(factor, 0.8);
      continue;
    }

    const Net before = state.x;
    accept(dynamics, options_, state, stage, dt, h, limit, error, factor, report);
    state.step = std::min(state.step, growth * dt);
    state.memory = Memory{stage.contraction, error, dt}.values();
    state.memory.insert(state.memory.end(), {dt, -times[1], times[1] - times[2]});
    state.history = {stage.slope, before, state.history[1], state.history[2]};
    state.secants = std::move(secants);
    return report;
  }
}

}  // namespace tanktread::motion
