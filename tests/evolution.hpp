#pragma once
// Run of a deck in memory, without files, for tests of the results of whole runs.

#include <memory>
#include <string>
#include <vector>

#include "deck/document.hpp"
#include "motion/integrator.hpp"
#include "scene/member.hpp"
#include "scene/scene.hpp"
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
    state.x = body().initial;
    motion::begin(*capsule, state);
    state.step = motion::first_step(*capsule, state, scene.time);
  }
  Evolution(const Evolution&) = delete;

  /// Advances by one step, not beyond the time `limit`. Throws RunFailure.
  motion::StepReport step(double limit) {
    const motion::StepReport report = scheme_->advance(*capsule, state, limit);
    ++steps;
    return report;
  }

  /// Integrates to a time. Throws RunFailure.
  void to(double time) {
    while (state.time < time) step(time);
  }

  const Body& body() const { return *members_.front().body; }
  surface::Deformation deformation() const { return surface::deformation(capsule->geometry(), state.x); }
  double volume_error() const { return capsule->volume_error(capsule->geometry().volume(state.x)); }
  double energy() const { return membrane::energy(capsule->membrane(), state.x); }

  Scene scene;
  std::shared_ptr<coupling::Capsule> capsule;
  motion::State state;
  int steps = 0;

 private:
  std::vector<Member> members_;
  Phases phases_;
  std::unique_ptr<motion::Integrator> scheme_;
};

}  // namespace tanktread
