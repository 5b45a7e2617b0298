#pragma once
// What a time integrator sees of the coupled system: dx/dt = v(x) and its quasi-Newton Jacobian.

#include <limits>
#include <vector>

#include "base/types.hpp"
#include "system/solids/rigid_motion.hpp"
#include "system/solvers/secants.hpp"

namespace tanktread::coupling {

/// The system (4.2). Nets are replicated; every call is collective. Where the motion changes in time, all is of the time that at() was told last.
class Dynamics {
 public:
  virtual ~Dynamics() = default;

  /// The time of all that follows, in a step that began at `start`: where the motion jumps, a step up to there has what was before, and one that
  /// starts there what comes after.
  virtual void at(double /*time*/, double /*start*/) {}

  /// The first time after `time` at which the motion is not smooth; no step may go beyond.
  virtual double next_kink(double /*time*/) const { return std::numeric_limits<double>::infinity(); }

  /// One velocity evaluation (4.2) at the control net x, volume constraint included. Not finite where the shape is beyond repair.
  virtual Net velocity(const Net& x) = 0;

  /// Assembles the layer operators that the Jacobian keeps frozen (4.3) at x.
  virtual void freeze(const Net& x) = 0;

  /// Bytes of what freeze() keeps that grows with the square of the mesh, on all ranks together.
  virtual double frozen_bytes() const { return 0; }

  /// Takes the membrane's tangent H of the Jacobian (4.3) at x.
  virtual void linearise(const Net& x) = 0;

  /// delta = (I - shift J)^{-1} r with the Jacobian (4.3) and what `secants` know beyond it, to the relative residual `tolerance`.
  /// `shift` is gamma dt.
  virtual Net solve(double shift, const Net& r, double tolerance, const Secants& secants) = 0;

  /// B (dv - J delta) where last linearised: what the Jacobian misses of the velocity's change dv that delta made; for Secants.
  virtual Net missed(const Net& dv, const Net& delta) = 0;

  /// What u lacks of being the velocity at x: v - u, up to a factor B that goes with x and that `correction` and `missed_of` know. Where velocities
  /// are solutions of systems B v = w it is w - B u, one sum over the surface and no system.
  virtual Net defect(const Net& x, const Net& u) { return velocity(x) - u; }

  /// Whether a velocity takes the solution of a linear system that its defect does not take.
  virtual bool defect_spares_system() const { return false; }

  /// `solve` for r = shift (v - u), given the defect of u.
  virtual Net correction(double shift, const Net& defect, double tolerance, const Secants& secants) {
    return solve(shift, shift * defect, tolerance, secants);
  }

  /// `missed`, from the change of the defect of (x - known)/shift, whatever is known, that delta made.
  virtual Net missed_of(const Net& change, const Net& delta, double shift) { return missed(change + delta / shift, delta); }

  /// J delta at x, where the velocity is v, delta of the norm of a shape: with the frozen operators (4.3) where there are any, else by a
  /// difference of velocities, which costs an evaluation.
  virtual Net derivative(const Net& x, const Net& v, const Net& delta) { return difference(x, v, delta); }

  /// What a displacement changes of the rate at which meshes move along interfaces by themselves, where last linearised; of no rows where none does.
  virtual Net mesh_motion(const Net& /*delta*/) { return {}; }

  /// Moves x onto the volume to be kept, if the constraint is `exact`; otherwise does nothing. Not finite where that cannot be done.
  virtual void restore_volume(Net& x) = 0;

  /// Makes y, where a stage of this shift is about to start, better by what is known of the shape `before` it: a membrane that nearly keeps its area
  /// has the tensions that it had.
  virtual void improve_start(Net& /*y*/, const Net& /*before*/, double /*shift*/) {}

  /// Fields that move points along surfaces and change no shape: rotations of the mesh of each drop that it slides on.
  virtual std::vector<Net> relabellings(const Net& /*x*/) { return {}; }

  /// Returns the velocity of a rigid motion about the origin at the state x.
  virtual Net moved(const Net& x, const RigidMotion& motion) const { return rigid_velocity(x, motion, Vec3::Zero()); }

  /// Returns the state x turned about the origin.
  virtual Net turned(const Net& x, const Mat3& rotation) const { return x * rotation.transpose(); }

  /// Rids a rate of change of what round-off adds where the scene is symmetric. A velocity is rid of it already; a difference of shapes is not,
  /// and what is extrapolated from it grows from step to step.
  virtual Net symmetric(Net rate) const { return rate; }

  /// How much a shape differs from the one on which operators were assembled: by default the norm of the displacement.
  virtual double distance(const Net& from, const Net& to) const { return norm(to - from); }

  /// The norm of `Time/tolerance`: root mean square of the control points' displacement over R_C.
  virtual double norm(const Net& displacement) const = 0;

 protected:
  /// (v(x + e delta) - v)/e for e delta of norm 1e-4: above the noise of adaptive quadrature, below what bends.
  Net difference(const Net& x, const Net& v, const Net& delta) {
    const double e = 1e-4 / norm(delta);
    return (velocity(x + e * delta) - v) / e;
  }
};

}  // namespace tanktread::coupling
