#pragma once
// What the time loop moves: a deforming capsule, or a free rigid body.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "motion/integrator.hpp"
#include "record/files/checkpoint.hpp"
#include "record/files/snapshot.hpp"
#include "scene/body.hpp"
#include "scene/particles/warnings.hpp"
#include "scene/series/diagnostics.hpp"
#include "scene/series/run_totals.hpp"
#include "scene/series/series.hpp"
#include "stokes/kernels/kernels.hpp"
#include "system/contact.hpp"
#include "system/coupled_motion.hpp"
#include "system/dynamics.hpp"

namespace tanktread {

/// A run to go on with.
struct Resumed {
  motion::State state;
  RunTotals totals;
  output::Checkpoint checkpoint;  ///< that holds it, and what `store` has put there
};

/// The particle at one moment, as a picture shows it.
struct SurfacePicture {
  Net surface;  ///< control net
  std::function<std::vector<output::Field>(const output::Nodes& nodes)> fields;
};

/// A particle as the time loop sees it. Every call is collective, except where a picture's fields are sampled.
class ParticleSystem {
 public:
  virtual ~ParticleSystem() = default;
  virtual coupling::Dynamics& dynamics() = 0;
  virtual const coupling::Capsule* capsule() const { return nullptr; }           ///< of what deforms
  virtual coupling::CoupledMotion* fields() { return nullptr; }                   ///< the motion with the fields on surfaces, if there are any
  virtual const Body& body() const = 0;
  virtual Net start() const = 0;                                                 ///< State::x at time zero
  virtual bool resume(Resumed& resumed) = 0;                                     ///< goes on; whether body() has another mesh now
  virtual void store(output::Checkpoint& checkpoint) const = 0;                  ///< adds what `resume` takes beside state and totals
  /// Discards the products that preconditioners `recycled` keep from earlier solves. No checkpoint holds them; after each one a run does without.
  virtual void forget_recycled() {}
  /// After a step of this size: moves what it left too close apart, if the deck asks for that; whether that could be done.
  virtual bool hold_apart(motion::State&, double /*step*/) { return true; }
  virtual coupling::Contacts contacts() const { return {}; }                      ///< that hold now
  virtual void hold_by(const coupling::Contacts&) {}                              ///< from now on, on the present mesh
  virtual bool adapt(motion::State& state, RunTotals& totals) = 0;              ///< after a step; whether body() has another mesh now
  virtual void undo_adapt(const Net&) {}                                         ///< goes back to the mesh before, in this shape, for a last picture
  virtual std::vector<Warning> remarks() { return {}; }                          ///< for the user, who is to hear of each kind once
  virtual coupling::Work work() const = 0;
  virtual std::vector<PhaseAngle> phase_angle() const = 0;                              ///< of each particle, as of the latest row
  virtual stokes::Evaluations kernel_evaluations() const = 0;
  virtual Columns row(const motion::State& state, ProgressRow progress) = 0;     ///< `progress`: time and work are set here
  virtual const surface::BezierMap& bezier() const = 0;                          ///< the extraction of body()
  virtual SurfacePicture picture(const motion::State& state) = 0;
};

/// What `Particle/motion` asks for.
std::unique_ptr<ParticleSystem> particle_system(const Scene& scene, coupling::Ranks& ranks, Phases& phases);

/// The kinds.
std::unique_ptr<ParticleSystem> deforming(const Scene& scene, coupling::Ranks& ranks, Phases& phases);
std::unique_ptr<ParticleSystem> free_body(const Scene& scene, coupling::Ranks& ranks, Phases& phases);

}  // namespace tanktread
