#pragma once
// Run of a deck in memory, without files, for tests of the results of whole runs.

#include <memory>
#include <string>
#include <vector>

#include "deck/document.hpp"
#include "motion/integrator.hpp"
#include "scene/member.hpp"
#include "scene/scene.hpp"
#include "system/coupled_motion.hpp"
#include "tests/membrane_totals.hpp"
#include "tests/shape_measures.hpp"

namespace tanktread {

/// Scene, its body, and the state of the run. Settings are `Section/key=value`, as for `--set`.
class Evolution {
 public:
  explicit Evolution(const std::vector<std::string>& settings) {
    std::vector<std::string> all = {"Time/final time=1"};  // default, which the settings may change
    all.insert(all.end(), settings.begin(), settings.end());
    deck::Document deck = deck::read({}, all);
    deck.declare(scene);
    scene.check();
    members_ = make_members(scene);
    arrange(members_);
    capsule = make_capsule(members_, body(), phases_, nullptr, std::nullopt);
    scheme_ = motion::integrator(scene.time);
    motion = std::make_unique<coupling::CoupledMotion>(*capsule);
    state.x = motion->start(body().initial);
    motion::begin(*motion, state);
    state.step = motion::first_step(*motion, state, scene.time);
  }
  Evolution(const Evolution&) = delete;

  /// Advances by one step, not beyond the time `limit`. Throws RunFailure.
  motion::StepReport step(double limit) {
    const motion::StepReport report = scheme_->advance(*motion, state, limit);
    ++steps;
    return report;
  }

  /// Integrates to a time. Throws RunFailure.
  void to(double time) {
    while (state.time < time) step(time);
  }

  const Body& body() const { return *members_.front().body; }
  Net x() const { return motion->shape(state.x); }  ///< control net of the current shape
  surface::Deformation deformation() const { return surface::deformation(capsule->geometry(), x()); }
  double volume_error() const { return capsule->volume_error(capsule->geometry().volume(x())); }
  double energy() const { return membrane::energy(capsule->membrane(), x()); }

  Scene scene;
  std::shared_ptr<coupling::Capsule> capsule;
  std::unique_ptr<coupling::CoupledMotion> motion;
  motion::TimeState state;
  int steps = 0;

 private:
  std::vector<Member> members_;
  Phases phases_;
  std::unique_ptr<motion::Integrator> scheme_;
};

}  // namespace tanktread
