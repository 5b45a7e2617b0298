#include "motion/quasi_newton.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"

namespace tanktread::motion {

namespace {
constexpr double worth_assembling = 0.3;  // least deformation since the last assembly, divided by R_C, for which a new assembly pays off
constexpr double without_rate = 0.1;      // factor of the allowed error where the contraction rate is assumed, not observed
}  // namespace

void solve(coupling::Dynamics& dynamics, const TimeOptions& options, const State& rhs, double shift, coupling::Secants& secants, Stage& stage) {
  double previous = 0;
  State before, delta;
  for (int k = 0; k < options.newton_iterations; ++k) {
    const State defect = dynamics.defect(stage.y, (stage.y - rhs) / shift);
    ++stage.iterations;
    if (!defect.allFinite()) return;
    // only the first correction gives a secant, because later corrections are so small that quadrature errors dominate them
    if (k == 1 && options.secants > 0) {
      const State jacobian_error = dynamics.jacobian_error(defect - before, delta, shift);
      if (!jacobian_error.allFinite()) return;
      secants.add(delta, jacobian_error, options.secants);
    }
    dynamics.linearise(stage.y);
    delta = dynamics.correction(shift, defect, options.linear_tolerance, secants);
    const double size = dynamics.norm(delta);
    if (!std::isfinite(size)) return;
    stage.y += delta;
    if (k > 0 && previous > 0) stage.rate = std::max(options.linear_tolerance, size / previous);
    const double rate = stage.rate_or_assumed();
    if (rate >= 1) return;
    stage.error = rate / (1 - rate) * size;
    if (stage.error < (stage.rate > 0 ? 1 : without_rate) * options.newton_tolerance * options.tolerance) {
      stage.slope = dynamics.symmetric((stage.y - rhs) / shift);
      stage.y = rhs + shift * stage.slope;
      stage.solved = true;
      return;
    }
    previous = size;
    before = defect;
  }
}

Verdict judge(coupling::Dynamics& dynamics, const TimeOptions& options, TimeState& state, coupling::Secants& secants, Stage& last, double error,
              int power, const Memory& memory) {
  // A newly assembled operator speeds up the iteration only if the shape has changed. Otherwise slow contraction is due to the terms neglected in
  // (4.3).
  const double changed = dynamics.distance(state.frozen, state.x);
  if (last.solved ? last.rate > options.contraction_limit && changed > worth_assembling : state.frozen != state.x) {
    freeze(dynamics, state, last.time);
    secants = state.secants = {};
  }
  if (!last.solved || !std::isfinite(error)) {
    if (options.fixed_step) throw RunFailure("the implicit step of fixed length did not converge: set a smaller Time/fixed step");
    return {};
  }
  const bool small = error <= 1 || options.fixed_step;
  if (small) dynamics.restore_constraints(last.y);
  if (options.fixed_step && !last.y.allFinite())
    throw RunFailure("the constraints were not restored after the implicit step of fixed length: set a smaller Time/fixed step");
  return {small && last.y.allFinite(), step_factor(error, small ? memory.error : 0, power)};
}

State interpolated(std::span<const double> times, std::span<const State* const> states, double t) {
  State sum(states[0]->layout());
  for (std::size_t i = 0; i < states.size(); ++i) {
    double weight = 1;
    for (std::size_t j = 0; j < states.size(); ++j)
      if (j != i) weight *= (t - times[j]) / (times[i] - times[j]);
    sum += weight * *states[i];
  }
  return sum;
}

}  // namespace tanktread::motion
