#include "motion/quasi_newton.hpp"

#include <algorithm>
#include <cmath>

namespace tanktread::motion {

namespace {
const double worth_assembling = 0.8;  // root mean square displacement over R_C since the last assembly
}

double Memory::expected_contraction(double dt) const { return std::min(0.9, contraction * (step > 0 ? dt / step : 1)); }

void solve(coupling::Dynamics& dynamics, const TimeOptions& options, const Net& rhs, double shift, Stage& stage) {
  double previous = 0;
  for (int k = 0; k < options.newton_iterations; ++k) {
    const Net residual = rhs + shift * dynamics.velocity(stage.y) - stage.y;
    ++stage.iterations;
    if (!residual.allFinite()) return;
    dynamics.linearise(stage.y);
    const Net delta = dynamics.solve(shift, residual, options.linear_tolerance);
    const double size = dynamics.norm(delta);
    stage.y += delta;
    if (!std::isfinite(size)) return;
    double& rate = stage.contraction;
    if (k > 0) rate = std::max(0.3 * rate, size / previous);
    if (rate >= 1) return;
    if (rate / (1 - rate) * size < options.newton_tolerance * options.tolerance) {
      stage.slope = dynamics.symmetric((stage.y - rhs) / shift);
      stage.y = rhs + shift * stage.slope;
      stage.solved = true;
      return;
    }
    previous = size;
  }
}

void refreeze(coupling::Dynamics& dynamics, const TimeOptions& options, State& state, bool solved, double contraction) {
  // A fresh operator helps only where the shape has moved on; the rest of the contraction rate is the part left out of (4.3).
  const double moved = dynamics.norm(state.x - state.frozen);
  if (solved ? contraction > options.contraction_limit && moved > worth_assembling : moved > 0) dynamics.freeze(state.frozen = state.x);
}

}  // namespace tanktread::motion
