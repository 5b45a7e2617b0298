#pragma once
// Interface of the time loop to the particles: a coupled system of particles, or a free rigid body.

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

/// Data with which a run is resumed.
struct Resumed {
  motion::TimeState state;        ///< without its vectors until ParticleSystem::resume()
  RunTotals totals;
  output::Checkpoint checkpoint;  ///< checkpoint with `state`, `totals` and the data that ParticleSystem::store() added
};

/// Shape of the particles at one time, and a function that samples their fields at the nodes of a snapshot on the calling rank. The function uses the
/// system of the particles. It must be called before the system changes its shape, time or mesh.
struct SurfaceSnapshot {
  Net surface;  ///< control net of the surfaces
  std::function<std::vector<output::Field>(const output::Nodes& nodes)> fields;
};

/// Interface of the particles to the time loop. Every call is collective, except SurfaceSnapshot::fields.
class ParticleSystem {
 public:
  virtual ~ParticleSystem() = default;
  virtual coupling::Dynamics& dynamics() = 0;
  virtual coupling::Capsule* capsule() const { return nullptr; }                 ///< returns the coupled system; null for a free rigid body
  /// Returns the motion of the surfaces together with their fields; null for a free rigid body.
  virtual coupling::CoupledMotion* coupled_motion() { return nullptr; }
  virtual const Body& body() const = 0;
  virtual coupling::State start() const = 0;                                     ///< returns TimeState::x at time zero
  /// Resumes a run: reads the vectors of `resumed.state` from the checkpoint. Returns true if this has changed the mesh of body(). Throws
  /// UserError if the checkpoint lacks a vector or has it in another size.
  virtual bool resume(Resumed& resumed) = 0;
  /// Changes to the mesh of another system of the same particles. `mesh`: data that store() of the other system has added. `x`: state on this mesh
  /// (TimeState::x). Operations before this call are no longer counted. Does nothing for a free rigid body, whose mesh never changes.
  virtual void move_to(const output::Checkpoint& /*mesh*/, const coupling::State& /*x*/) {}
  virtual void store(output::Checkpoint& checkpoint) const = 0;  ///< adds the data that `resume` needs in addition to state and totals
  /// Moves particles apart after a step of this size if their gap is below the limit and the deck requests `Contact/limiter`. Returns false if that
  /// fails.
  virtual bool enforce_gaps(motion::TimeState&, double /*step*/) { return true; }
  virtual coupling::Contacts contacts() const { return {}; }                      ///< returns the current contacts
  virtual void set_contacts(const coupling::Contacts&) {}  ///< sets the contact forces that act from now on; they refer to the current mesh
  /// Moves the centroid back if it is held, then adapts meshes after a step; returns true if this has changed the mesh of body().
  virtual bool adapt(motion::TimeState& state, RunTotals& totals) = 0;
  virtual void undo_adapt(const coupling::State&) {}  ///< returns to the previous mesh, in the given state, for a last snapshot
  /// Returns a sentence about the membrane that is compressed most at the state x although its resistance to bending is too small for its mesh, and
  /// what to do about it in a search for a steady shape; empty if there is none.
  virtual std::string slackness(const coupling::State& /*x*/) const { return {}; }
  virtual std::vector<Warning> remarks() { return {}; }  ///< returns warnings for the user; each kind is to be shown only once
  virtual coupling::OperationCounts counts() const = 0;
  virtual void set_counts(const coupling::OperationCounts& counts) = 0;  ///< sets the counts of the operations so far
  /// Discards what evaluations keep for later ones and checkpoints do not contain, so that a resumed run makes the same evaluations.
  virtual void forget() {}
  /// Returns the phase angle of each particle when the series were last computed.
  virtual std::vector<PhaseAngle> phase_angle() const = 0;
  /// Returns the number of kernel evaluations on this rank, without the evaluations that SharedOptions::walls counts.
  virtual stokes::Evaluations kernel_evaluations() const = 0;
  /// Advances the phase angles by the step that led to the state (`progress.step`). Returns a row of results: the data of the particles and of
  /// `progress`, with the time and the work of the run. To be called once per row, in the order of times.
  virtual Columns next_row(const motion::TimeState& state, const ProgressRow& progress) = 0;
  virtual const surface::BezierMap& bezier() const = 0;                          ///< returns the Bezier extraction of body()
  virtual Net surface(const coupling::State& x) const = 0;                       ///< returns the control net of all surfaces in the state x
  /// Returns the surface and the fields of a snapshot.
  virtual SurfaceSnapshot snapshot(const motion::TimeState& state) = 0;
};

/// Builds the system for the particles of the scene: a coupled system, or a free rigid body.
std::unique_ptr<ParticleSystem> make_particle_system(const Scene& scene, coupling::Ranks& ranks, Phases& phases);

/// Throws UserError if particles overlap walls, posts or each other at their start, or are closer than a run allows.
void check_room(const Scene& scene);

/// Builds the particles of the scene at their start, and discards them. Throws UserError if they cannot start there. Collective.
void check_start(const Scene& scene);

/// Builds a coupled system of particles.
std::unique_ptr<ParticleSystem> make_coupled_particles(const Scene& scene, coupling::Ranks& ranks, Phases& phases);
/// Builds a system that consists of one free rigid body.
std::unique_ptr<ParticleSystem> make_free_body(const Scene& scene, coupling::Ranks& ranks, Phases& phases);

}  // namespace tanktread
