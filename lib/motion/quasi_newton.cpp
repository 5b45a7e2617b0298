#include "motion/quasi_newton.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/errors.hpp"

namespace tanktread::motion {

namespace {
const double worth_assembling = 0.8;  // root mean square displacement over R_C since the last assembly
const double doubtful = 0.3;          // contraction rate expected where an attempt erred too much
}

double Memory::expected_contraction(double dt) const { return std::min(0.9, std::max(least, contraction * (step > 0 ? dt / step : 1))); }

void solve(coupling::Dynamics& dynamics, const TimeOptions& options, const Net& rhs, double shift, coupling::Secants& secants, Stage& stage) {
  double previous = 0;
  Net before, delta;
  for (int k = 0; k < options.newton_iterations; ++k) {
    const Net defect = dynamics.defect(stage.y, (stage.y - rhs) / shift);
    ++stage.iterations;
    if (!defect.allFinite()) return;
    if (k > 0 && options.secants > 0) {
      const Net missed = dynamics.missed_of(defect - before, delta, shift);
      if (!missed.allFinite()) return;
      secants.add(delta, missed, options.secants);
    }
    dynamics.linearise(stage.y);
    delta = dynamics.correction(shift, defect, options.linear_tolerance, secants);
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
    before = defect;
  }
}

Verdict judge(coupling::Dynamics& dynamics, const TimeOptions& options, State& state, Stage& last, double error, int power, Memory& memory) {
  // A fresh operator helps only where the shape has moved on; the rest of the contraction rate is the part left out of (4.3).
  const double moved = dynamics.norm(state.x - state.frozen);
  if (last.solved ? last.contraction > options.contraction_limit && moved > worth_assembling : moved > 0) dynamics.freeze(state.frozen = state.x);
  if (!last.solved || !std::isfinite(error)) {
    memory.contraction = std::min(0.5, last.contraction);
    if (options.fixed_step) throw RunFailure("the implicit step of fixed size did not converge");
    return {};
  }
  const bool small = error <= 1 || options.fixed_step;
  if (!small) memory.least = doubtful;
  if (small) dynamics.restore_volume(last.y);
  return {small && last.y.allFinite(), step_factor(error, small ? memory.error : 0, power)};
}

Net interpolated(std::span<const double> times, std::span<const Net* const> nets, double t) {
  Net sum = Net::Zero(nets[0]->rows(), 3);
  for (std::size_t i = 0; i < nets.size(); ++i) {
    double weight = 1;
    for (std::size_t j = 0; j < nets.size(); ++j)
      if (j != i) weight *= (t - times[j]) / (times[i] - times[j]);
    sum += weight * *nets[i];
  }
  return sum;
}

}  // namespace tanktread::motion
