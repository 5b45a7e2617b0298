#pragma once
// The coupled system: kinds of equations for blocks of unknowns, and the one residual that all solves use.

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "system/blocks/block_vector.hpp"
#include "system/solvers/krylov.hpp"
#include "system/targets/layers_at.hpp"

namespace tanktread::coupling {

/// Part of a residual: with the terms that do not depend on the unknowns (ambient flow, given loads, forces and motions), or only the linear terms.
enum class Given { included, omitted };

/// Velocities on the particles. `at_targets`, `control_values`: caused by the sources, at the targets and as control values R^-1 u. `of_points`: of
/// the fluid at the control points, as the unknowns state it. The last two are computed at first use.
class SurfaceVelocity {
 public:
  /// `map`: R^-1. `of_points`: computes of_points().
  SurfaceVelocity(LayersAt& layers, const Sources& sources, std::function<Net(const Net&)> map, std::function<Net()> of_points)
      : at_targets_(velocities(layers, sources, &known_)), map_(std::move(map)), find_points_(std::move(of_points)) {}
  /// Velocities of which only of_points() is known.
  explicit SurfaceVelocity(Net of_points) : of_points_(std::move(of_points)) {}

  /// Returns the velocity at the targets; without the ambient velocity if its control values are known (LayersAt::ambient_control_values).
  const Net& at_targets() const { return at_targets_; }
  const Net& control_values() const {
    if (!control_values_) control_values_ = known_.size() > 0 ? Net(known_ + map_(at_targets_)) : map_(at_targets_);
    return *control_values_;
  }
  const Net& of_points() const {
    if (!of_points_) of_points_ = find_points_();
    return *of_points_;
  }

 private:
  Net known_, at_targets_;
  std::function<Net(const Net&)> map_;
  std::function<Net()> find_points_;
  mutable std::optional<Net> control_values_, of_points_;
};

/// One kind of unknown on all surfaces that have it, with the equations that determine it, at one shape. The unknowns of the particles are three
/// numbers per control point, whose meaning depends on the kind of the particle: System::particles gives all of them as one net. All other unknowns
/// are blocks of their equations.
class Equation {
 public:
  virtual ~Equation() = default;

  virtual std::string plan() const { return {}; }  ///< what it determines, and how if the unknowns are eliminated; for the plan

  /// Removes from x, unknowns or a residual, what this equation eliminates by a projection P: x becomes P x.
  virtual void project(BlockVector& /*x*/) const {}

  /// Adds the loads and velocities that the unknowns x put on the surfaces. A load may be given by its virtual work (Sources::work).
  virtual void add_sources(const BlockVector& /*x*/, Given, Sources& /*to*/) const {}

  /// Adds the loads on the particles of this equation whose virtual work is `to.work`.
  virtual void add_loads_of_work(Sources& /*to*/) const {}

  /// Adds the velocity of the control points of this equation's particles to v, in their rows.
  virtual void add_velocity(const BlockVector& /*x*/, Given, Net& /*v*/) const {}

  /// Sets what a wall puts on the fluid, in answer to the sources of all particles: by its unknowns in x or, if they are eliminated, by its factors.
  virtual void answer(const BlockVector& /*x*/, Given, Sources& /*to*/) const {}

  /// Adds to r how much x violates this equation. `u`: velocity that the sources cause on the particles.
  virtual void add_residual(const BlockVector& /*x*/, const Sources&, const SurfaceVelocity& /*u*/, Given, BlockVector& /*r*/) const {}

  /// Changes x, an approximate solution for the residual r in which earlier equations have set their unknowns, to one that solves this equation too.
  /// Unknowns that no equation sets are equal to their rows of r.
  virtual void precondition(const BlockVector& /*r*/, BlockVector& /*x*/) const {}
};

/// The linear system of all unknowns at one shape: the only statement of the equations. Its residual is affine in the unknowns x. The right-hand side
/// of a solve is -residual(0, included), the product of an iterative solver residual(x, omitted), and the defect of given velocities
/// residual(x, included).
class System {
 public:
  using Equations = std::vector<std::unique_ptr<const Equation>>;

  /// `layers`: the targets on the particles. `control_values`: returns the control values of a velocity at the targets, R^-1 u.
  System(std::shared_ptr<const Layout> unknowns, Equations equations, std::shared_ptr<LayersAt> layers,
         std::function<Net(const Net&)> control_values);

  const std::shared_ptr<const Layout>& unknowns() const { return unknowns_; }
  std::string plan() const;  ///< blocks of unknowns with their sizes, and the equations
  static Eigen::Map<Net> particles(BlockVector& x);              ///< unknowns of all particles, one row per control point
  static Eigen::Map<const Net> particles(const BlockVector& x);
  BlockVector of(const Net& particles) const;                    ///< returns unknowns with these unknowns of the particles, and zero for all others

  /// Returns the loads and velocities that x puts on the particles, without the answer of walls.
  Sources sources(const BlockVector& x, Given given) const;

  /// Returns how much x violates the equations: P (B P x - w) + (1 - P) x, with the operator B and the right-hand side w of (4.2) and the projection
  /// P of the equations. `found`: if given, receives all sources.
  BlockVector residual(const BlockVector& x, Given given, Sources* found = nullptr) const;
  BlockVector right_hand_side(Sources* found = nullptr) const;   ///< -residual(0, included)
  /// Returns the load of the fluids on all particles. `work`: if given, receives the part that equations state by its virtual work (Sources::work).
  Net load(const BlockVector& x, Net* work = nullptr) const;
  /// Returns the velocity of the fluids at the control points, by Equation::add_velocity.
  Net velocity(const BlockVector& x, Given given) const;

  /// Removes from x what the equations eliminate by projection: P x.
  BlockVector projected(BlockVector x) const;

  /// Sets an approximate inverse of the rows of the particles; by default, and if it is empty, the identity.
  void set_inverse_of_particles(Apply of_particles) { of_particles_ = std::move(of_particles); }
  BlockVector precondition(const BlockVector& r) const;

  /// Solves residual(x, omitted) = right to the relative residual `tolerance`, from the guess x.
  SolveReport solve(const Krylov& krylov, const BlockVector& right, BlockVector& x, double tolerance) const;

 private:
  std::shared_ptr<const Layout> unknowns_;
  Equations equations_;
  std::shared_ptr<LayersAt> layers_;
  std::function<Net(const Net&)> control_values_;
  Apply of_particles_;
};

}  // namespace tanktread::coupling
