#pragma once
// A scene whose steady or periodic shapes are searched for.

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "motion/guarded.hpp"
#include "motion/steady.hpp"
#include "scene/particles/particle_system.hpp"
#include "scene/scene.hpp"
#include "scene/searches/searches.hpp"
#include "system/shape_coordinates.hpp"

namespace tanktread {

/// A scene and the motion of its particles. A branch of steady shapes has one system per value of its parameters (see SystemPool).
struct SteadySystem {
  SteadySystem(Scene of, coupling::Ranks& ranks, Phases& phases)
      : scene(std::move(of)), particles(make_coupled_particles(scene, ranks, phases)) {
    begin(particles->start());
  }

  /// Sets up the motion and the equations of steady shapes on the current mesh of the particle. `x`: shape on this mesh from which the search starts.
  void begin(const coupling::State& x) {
    motion.emplace(particles->dynamics());
    motion->set_time(0, 0);
    const Body& body = particles->body();
    equations.emplace(*motion, free_motions(scene, body.flow, body.radius, particles->capsule()->particles()), steady_step(scene), x,
                      [this](const coupling::State& y) { return particles->slackness(y); });
  }

  /// Returns the mesh, for move_to().
  output::Checkpoint mesh() const {
    output::Checkpoint mesh;
    particles->store(mesh);
    return mesh;
  }

  /// Changes to the mesh of another system, and then calls begin(). Collective.
  void move_to(const output::Checkpoint& mesh, const coupling::State& x) {
    particles->move_to(mesh, x);
    begin(x);
  }

  /// Returns false if the symmetry of the shape cannot be applied to all surface fields, because their symmetric images are not known.
  bool knows_images() const { return particles->coupled_motion()->knows_images(particles->body().symmetry); }

  /// Returns the coordinates of changes of the state x. `symmetry`: symmetry of the shape, which must outlive the result. `parity`: parity of the
  /// changes under reflections of x1, x2, x3.
  coupling::ShapeCoordinates coordinates(const coupling::State& x, const surface::Symmetry& symmetry, const Vec3& parity = Vec3::Ones()) {
    return {*particles->coupled_motion(), x, symmetry, parity};
  }

  /// Returns the state `after` without the motion of control points along interfaces since the state `before`. If both are the same shape, the result
  /// differs from `before` by a term of the order of the cube of this motion:
  ///
  ///   before + D y(after - before),   with y and its displacement D y of (4.15) and (4.34) at the mean of both states
  ///
  /// because a point that slides along a circle moves at right angles to the normal at the middle of its way. Collective.
  coupling::State without_sliding(const coupling::State& before, const coupling::State& after) {
    if (std::ranges::none_of(particles->capsule()->particles(), &coupling::Particle::slides)) return after;
    const surface::Symmetry none;
    const coupling::ShapeCoordinates shapes = coordinates(0.5 * (before + after), knows_images() ? particles->body().symmetry : none);
    return before + shapes.displacement(shapes.coordinates(after - before));
  }

  Scene scene;
  std::unique_ptr<ParticleSystem> particles;
  std::optional<motion::GuardedDynamics> motion;
  std::optional<motion::SteadyEquations> equations;
};

/// Returns the equations of steady shapes of the system. They share the ownership of the system.
inline std::shared_ptr<motion::SteadyEquations> equations_of(const std::shared_ptr<SteadySystem>& system) { return {system, &*system->equations}; }

}  // namespace tanktread
