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
  /// `stops`: function that returns true if this rank is to stop because of a signal or a limit (see GuardedDynamics).
  System(Scene of, coupling::Ranks& ranks, Phases& phases, std::function<bool()> stops)
      : scene(std::move(of)), particle(deforming(scene, ranks, phases)), is_to_stop(std::move(stops)) {
    begin(particle->start());
  }

  /// Sets up the motion and the equations of steady shapes on the current mesh of the particle. `x`: shape on this mesh from which the search starts.
  void begin(const Net& x) {
    motion.emplace(particle->dynamics(), is_to_stop);
    motion->at(0, 0);
    const Body& body = particle->body();
    equations.emplace(*motion, free_motions(scene, body.flow, body.radius, particle->capsule()->particles()), steady_step(scene), x);
  }

  /// Returns the state `after` without the motion of control points along interfaces since the state `before`. If both are the same shape, the result
  /// differs from `before` by the cube of this motion:
  ///
  ///   before + D y(after - before),   with y and its displacement D y of (4.15) and (4.34) at the mean of both states
  ///
  /// because a point that slides along a circle moves at right angles to the normal at the middle of its way. Collective.
  Net without_sliding(const Net& before, const Net& after);

  Scene scene;
  std::unique_ptr<ParticleSystem> particle;
  std::function<bool()> is_to_stop;
  std::optional<motion::GuardedDynamics> motion;
  std::optional<motion::SteadyEquations> equations;
};

}  // namespace tanktread
