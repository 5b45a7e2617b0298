#pragma once
// Equations of the unknowns on particles: velocities of deformable particles, and densities or tractions of rigid bodies.

#include <span>
#include <string>
#include <utility>

#include "system/membranes.hpp"
#include "system/solids/bodies/body_layer.hpp"
#include "system/solids/bodies/rigid_particles.hpp"
#include "system/system.hpp"

namespace tanktread::coupling {

/// Velocity v of deformable particles: v - R^-1 u = 0 (4.2). v is a density if lambda != 1, and a load if a membrane is viscous (3.11). References of
/// the classes here must outlive their objects.
class DeformableVelocities : public Equation {
 public:
  /// `load`: given load at the shape x, no rows if there is none. `has_double`: whether any particle has a double layer.
  DeformableVelocities(std::span<const Particle> particles, Membranes& membranes, Net x, Net load, bool has_double)
      : particles_(particles), membranes_(membranes), x_(std::move(x)), load_(std::move(load)), has_double_(has_double) {}

  std::string plan() const override { return "velocities of deformable particles"; }
  void add_sources(const BlockVector& x, Given given, Sources& to) const override;
  void add_loads_of_work(Sources& to) const override;
  void add_velocity(const BlockVector& x, Given given, Net& v) const override;
  void add_residual(const BlockVector& x, const Sources& from, const SurfaceVelocity& u, Given given, BlockVector& r) const override;

 private:
  std::span<const Particle> particles_;
  Membranes& membranes_;
  Net x_, load_;
  bool has_double_;
};

/// Density w of rigid bodies, with their mean motion (2.23). See RigidParticles.
class BodyDensities : public Equation {
 public:
  BodyDensities(std::span<const Particle> particles, const RigidParticles& rigid) : particles_(particles), rigid_(rigid) {}

  std::string plan() const override { return "double-layer densities of rigid bodies, with their motions"; }
  void add_sources(const BlockVector& x, Given given, Sources& to) const override;
  void add_loads_of_work(Sources& to) const override;
  void add_velocity(const BlockVector& x, Given given, Net& v) const override;
  void add_residual(const BlockVector& x, const Sources& from, const SurfaceVelocity& u, Given given, BlockVector& r) const override;

 private:
  std::span<const Particle> particles_;
  const RigidParticles& rigid_;
};

/// Force density of rigid bodies, for given velocities at their sites: u = 0 (2.40) of bodies at rest. On a lattice, where the layers do not contain
/// the regularising term of `bodies` (2.10), it is added.
class BodyTractions : public Equation {
 public:
  BodyTractions(std::span<const Particle> particles, const BodyLayer& bodies, bool on_lattice)
      : particles_(particles), bodies_(bodies), on_lattice_(on_lattice) {}

  std::string plan() const override { return "tractions on rigid bodies, whose motions are eliminated by unit motions"; }
  void add_sources(const BlockVector& x, Given given, Sources& to) const override;
  void add_residual(const BlockVector& x, const Sources& from, const SurfaceVelocity& u, Given given, BlockVector& r) const override;

 private:
  std::span<const Particle> particles_;
  const BodyLayer& bodies_;
  bool on_lattice_;
};

}  // namespace tanktread::coupling
