#pragma once
// A scene whose steady or periodic shapes are searched for.

#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "motion/guarded.hpp"
#include "motion/steady.hpp"
#include "scene/particles/particle_system.hpp"
#include "scene/scene.hpp"
#include "scene/searches.hpp"

namespace tanktread {

/// A scene and the motion of its particles. A branch of steady shapes has one system per value of its parameters.
struct System {
  /// `is_to_stop`: function that returns true if this rank is to stop because of a signal or a limit (see GuardedDynamics).
  System(Scene of, coupling::Ranks& ranks, Phases& phases, std::function<bool()> is_to_stop)
      : scene(std::move(of)), particle(deforming(scene, ranks, phases)), told(std::move(is_to_stop)) {
    begin(particle->start());
  }

  /// Sets up the motion and the equations of steady shapes on the current mesh of the particle. `x`: shape on this mesh from which the search starts.
  void begin(const Net& x) {
    motion.emplace(particle->dynamics(), told);
    motion->at(0, 0);
    const Body& body = particle->body();
    equations.emplace(*motion, free_motions(scene, body.flow, body.radius, particle->capsule()->particles()), steady_step(scene), x);
  }

  Scene scene;
  std::unique_ptr<ParticleSystem> particle;
  std::function<bool()> told;
  std::optional<motion::GuardedDynamics> motion;
  std::optional<motion::SteadyEquations> equations;
};

}  // namespace tanktread
