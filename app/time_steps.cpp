#include "app/time_steps.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "base/errors.hpp"
#include "motion/guarded.hpp"

namespace tanktread {

namespace {

/// Returns the options of the time integration. If steps do not end at snapshot times, they are at most as long as the time between two snapshots, so
/// that each snapshot has its own step.
motion::TimeOptions time_options(const Scene& scene) {
  motion::TimeOptions time = scene.time_options();
  if (!scene.lands_on_snapshots() && !time.fixed_step)
    time.maximum_step = std::min(scene.snapshot_interval(), time.maximum_step.value_or(scene.snapshot_interval()));
  return time;
}

}  // namespace

TimeSteps::TimeSteps(const Scene& scene, ParticleSystem& particles)
    : scene_(scene), particles_(particles), scheme_(motion::integrator(time_options(scene), scene.solvers.nox)) {}

void TimeSteps::advance(motion::TimeState& state, double limit, motion::TimeState& before) {
  motion::GuardedDynamics motion(particles_.dynamics());
  try {
    if (motion::cross_kink(motion, state)) before = state;
    if (!state.history.front().allFinite()) throw RunFailure("the evaluation of the velocity failed at the start of a step");
    began_ = state.time;
    advance_apart(motion, state, limit, before);
  } catch (const RunFailure& failure) {
    const std::string what = failure.what();
    const std::string& why = motion.failure();
    throw RunFailure(what + (why.empty() || why == what ? "" : " after a failed evaluation of the velocity: " + why));
  }
}

/// Makes a time step. If particles are too close after the step for the contact limiter to keep them apart, repeats the step from the state
/// `before` with half its size.
void TimeSteps::advance_apart(coupling::Dynamics& motion, motion::TimeState& state, double limit, const motion::TimeState& before) {
  motion::StepReport discarded;  // sums over the steps that are repeated
  for (;;) {
    report_ = scheme_->advance(motion, state, limit);
    report_.iterations += discarded.iterations, report_.rejected += discarded.rejected;
    if (particles_.enforce_gaps(state, report_.step)) return;
    if (scene_.time.fixed_step)
      throw RunFailure(
          "after a step of fixed length particles are too close for Contact/limiter to hold them apart: set a smaller Time/fixed step");
    discarded.iterations = report_.iterations, discarded.rejected = report_.rejected + 1;
    coupling::State frozen = std::move(state.frozen);
    const double frozen_time = state.frozen_time;
    state = before;
    if (state.frozen != frozen) state.secants = {};  // they belong to the old operator
    state.frozen = std::move(frozen), state.frozen_time = frozen_time;
    state.step = report_.step / 2;
  }
}

}  // namespace tanktread
