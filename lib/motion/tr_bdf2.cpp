#include "motion/tr_bdf2.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "motion/slopes.hpp"

namespace tanktread::motion {

namespace {

const double d = 1 - 1 / std::sqrt(2.0);
const double w = std::sqrt(2.0) / 4;
const double worth_assembling = 0.8;  // root mean square displacement over R_C since the last assembly

/// The controller's memory as it stands in State::memory.
struct Memory {
  double contraction = 0.3;  ///< contraction rate of the quasi-Newton iteration per unit of `step`
  double error = 0;          ///< local error of the last accepted step over the tolerance; 0 before the first
  double step = 0;           ///< its size

  static Memory from(const std::vector<double>& m) { return m.size() == 3 ? Memory{m[0], m[1], m[2]} : Memory{}; }
  std::vector<double> values() const { return {contraction, error, step}; }
};

}  // namespace

bool TrBdf2::solve_stage(coupling::Dynamics& dynamics, const Net& rhs, double shift, Net& y, Net& slope, double& contraction,
                         int& iterations) const {
  double previous = 0;
  for (int k = 0; k < options_.newton_iterations; ++k) {
    const Net residual = rhs + shift * dynamics.velocity(y) - y;
    ++iterations;
    if (!residual.allFinite()) return false;
    dynamics.linearise(y);
    const Net delta = dynamics.solve(shift, residual, options_.linear_tolerance);
    const double size = dynamics.norm(delta);
    y += delta;
    if (!std::isfinite(size)) return false;
    if (k > 0) contraction = std::max(0.3 * contraction, size / previous);
    if (contraction >= 1) return false;
    if (contraction / (1 - contraction) * size < options_.newton_tolerance * options_.tolerance) {
      slope = (y - rhs) / shift;
      return true;
    }
    previous = size;
  }
  return false;
}

StepReport TrBdf2::advance(coupling::Dynamics& dynamics, State& state, double limit) {
  if (state.history.empty()) state.history = {dynamics.velocity(state.x)};
  if (state.frozen.size() == 0) dynamics.freeze(state.frozen = state.x);
  Memory memory = Memory::from(state.memory);
  StepReport report;
  double h = options_.fixed_step ? *options_.fixed_step : state.step;

  for (;; ++report.rejected) {
    refuse_tiny_step(h, state.time, limit, options_);
    const double dt = step_towards(state.time, limit, h), shift = d * dt;
    Slopes slopes(state.history, memory.step);
    const Net& k1 = state.history.front();
    double contraction = std::min(0.9, memory.contraction * (memory.step > 0 ? dt / memory.step : 1));

    const Net rhs2 = state.x + shift * k1;
    Net y = rhs2 + shift * slopes.at(2 * d * dt, options_.predictor_order), k2, k3;
    bool solved = solve_stage(dynamics, rhs2, shift, y, k2, contraction, report.iterations);
    double error = 0;
    if (solved) {
      slopes.add(2 * d * dt, k2);
      const Net rhs3 = state.x + dt * w * (k1 + k2);
      y = rhs3 + shift * slopes.at(dt, options_.predictor_order);
      solved = solve_stage(dynamics, rhs3, shift, y, k3, contraction, report.iterations);
    }
    if (solved) {
      const Net raw = dt * ((4 * w - 1) / 3 * k1 - k2 / 3 + 2 * d / 3 * k3);
      error = dynamics.norm(dynamics.solve(shift, raw, options_.linear_tolerance)) / options_.tolerance;
    }
    // A fresh operator helps only where the shape has moved on; the rest of the contraction rate is the part left out of (4.3).
    const double moved = dynamics.norm(state.x - state.frozen);
    if (solved ? contraction > options_.contraction_limit && moved > worth_assembling : moved > 0) dynamics.freeze(state.frozen = state.x);
    if (!solved) memory.contraction = std::min(0.5, contraction);
    const bool accepted = solved && (error <= 1 || options_.fixed_step);
    if (!solved && options_.fixed_step) throw RunFailure("the implicit step of fixed size did not converge");
    // PI controller; the contraction rate grows with the step and is kept below its limit too.
    double factor = 0.5;
    if (solved) {
      const double e = std::max(error, 1e-3), old = memory.error > 0 && accepted ? std::max(memory.error, 1e-3) : e;
      factor = std::clamp(0.9 * std::pow(1 / e, 0.7 / 3) * std::pow(old / e, 0.4 / 3), 0.3, 2.0);
      if (!accepted) factor = std::min(factor, 0.8);
    }
    if (!accepted) {
      h = dt * factor;
      continue;
    }

    dynamics.restore_volume(y);
    report.step = dt;
    report.error = error * options_.tolerance;
    report.displacement = dynamics.norm(y - state.x);
    state.history = {k3, k2, k1};
    state.x = y;
    state.time = dt == limit - state.time ? limit : state.time + dt;
    // A step shortened to meet `limit` says nothing against the longer one.
    state.step = std::min(dt < h ? std::max(h, dt * factor) : dt * factor, options_.maximum_step.value_or(1e300));
    memory = {contraction, error, dt};
    state.memory = memory.values();
    return report;
  }
}

}  // namespace tanktread::motion
