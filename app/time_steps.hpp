#pragma once
// Time steps of a run, with the repetitions that the contact limiter requires.

#include <memory>

#include "motion/integrator.hpp"
#include "scene/particles/particle_system.hpp"

namespace tanktread {

/// Makes the time steps of a run by the time scheme of the deck. Every call is collective.
class TimeSteps {
 public:
  TimeSteps(const Scene& scene, ParticleSystem& particles);

  /// Makes a step that ends at the time `limit` or earlier. If the motion is not smooth at the start of the step (a kink), the scheme restarts there,
  /// and `before` becomes the state after the kink. Throws RunFailure if the step fails, and Stopped if a stop signal arrives within the
  /// step.
  void advance(motion::TimeState& state, double limit, motion::TimeState& before);

  const motion::StepReport& report() const { return report_; }  ///< returns the report of the last step
  double began() const { return began_; }                       ///< returns the time at which the last step began

 private:
  void advance_apart(coupling::Dynamics& motion, motion::TimeState& state, double limit, const motion::TimeState& before);

  const Scene& scene_;
  ParticleSystem& particles_;
  std::unique_ptr<motion::Integrator> scheme_;
  motion::StepReport report_;
  double began_ = 0;
};

}  // namespace tanktread
