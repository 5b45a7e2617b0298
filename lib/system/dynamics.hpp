#pragma once
// Interface between a time integrator and the coupled system: dx/dt = v(x) and its quasi-Newton Jacobian.

#include <limits>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "system/blocks/block_vector.hpp"
#include "system/rigid_motion.hpp"
#include "system/solvers/secants.hpp"

namespace tanktread::coupling {

/// Returns a net of NaN with as many rows as `like`.
inline Net not_a_number(const Net& like) { return Net::Constant(like.rows(), 3, std::numeric_limits<double>::quiet_NaN()); }

/// Returns a state of NaN with the layout of `like`, which stands for a failed evaluation.
inline State not_a_number(const State& like) {
  State result(like.layout());
  result.numbers().setConstant(std::numeric_limits<double>::quiet_NaN());
  return result;
}

/// Returns the velocity of the state x in a rigid motion about the origin. Rows of vectors are positions; numbers do not change.
inline State moved(const State& x, const RigidMotion& motion) {
  State velocity(x.layout());
  for (std::size_t k = 0; k < x.layout()->blocks().size(); ++k)
    if (const BlockId id{k}; (*x.layout())[id].parity == Parity::polar) velocity(id) = rigid_velocity(x(id), motion, Vec3::Zero());
  return velocity;
}

/// Returns the state x rotated about the origin.
inline State turned(State x, const Mat3& rotation) {
  for (std::size_t k = 0; k < x.layout()->blocks().size(); ++k)
    if (const BlockId id{k}; (*x.layout())[id].parity == Parity::polar) x(id) = (x(id) * rotation.transpose()).eval();
  return x;
}

/// The system dx/dt = v(x) (4.2) of the state x: blocks "shape" with the control points of each particle and blocks of the fields on its surface, or
/// the pose of a rigid body. States are replicated on all ranks, and every call is collective. If the motion depends on time, all calls refer to the
/// time passed to set_time() last. By default the Jacobian is 0, as for motions that are not stiff. motion::GuardedDynamics wraps another motion and
/// must forward every function (checked by tests/style/structure.py).
class Dynamics {
 public:
  virtual ~Dynamics() = default;

  // Required of every motion.

  /// Evaluates the velocity (4.2) at the state x, including the volume constraint. Not finite if the shape is degenerate.
  virtual State velocity(const State& x) = 0;

  /// Returns why the latest velocity or defect() is not finite, for messages.
  virtual std::string why_undefined() const { return "it is not a number"; }

  /// Corrects x so that it satisfies the constraints again that a step satisfies only approximately: rigid bodies keep their shape, quaternions have
  /// the norm 1, and particles have the prescribed volumes if the volume constraint is `exact`. If the iteration fails, x becomes NaN.
  /// The displacements that restore volumes may use the Jacobian of the last linearisation.
  virtual void restore_constraints(State& x) = 0;

  /// Returns the norm in which `Time/tolerance` is measured: the root mean square of the control points' displacement, divided by R_C.
  virtual double norm(const State& displacement) const = 0;

  // Time.

  /// Sets the time for all later calls, within a step that began at `start`. If the motion jumps at the time `time`, a step that ends there uses the
  /// limit from earlier times, and a step that starts there uses the limit from later times.
  virtual void set_time(double /*time*/, double /*start*/) {}

  /// Returns the first time after `time` at which the motion is not smooth in time; no step may cross it.
  virtual double next_kink(double /*time*/) const { return std::numeric_limits<double>::infinity(); }

  // Implicit steps: Jacobian, residuals and start values.

  /// Assembles the layer operators that the Jacobian keeps frozen (4.3) at x.
  virtual void freeze(const State& /*x*/) {}

  /// Returns the size in bytes, over all ranks, of those frozen operators that grow with the square of the number of control points,
  /// without those of the images in a periodic duct.
  virtual double frozen_bytes() const { return 0; }

  /// Returns true if freeze() uses a periodic lattice that changes in time. The time set by set_time() must then be the time of the shape passed to
  /// freeze().
  virtual bool lattice_moves() const { return false; }

  /// Returns how much a shape differs from the shape at which operators were assembled: by default the norm of the displacement.
  virtual double distance(const State& from, const State& to) const { return norm(to - from); }

  /// Evaluates the membrane tangent H of the Jacobian (4.3) at x. If velocity(x) was the latest evaluation, the Jacobian includes the change of the
  /// mesh motion along interfaces, which depends on the fluid velocity.
  virtual void linearise(const State& /*x*/) {}

  /// Solves delta = (I - shift J)^{-1} r to the relative residual `tolerance`, with the Jacobian J (4.3) corrected by `secants`. `shift` is gamma dt.
  virtual State solve(double /*shift*/, const State& r, double /*tolerance*/, const Secants& /*secants*/) { return r; }

  /// Returns the defect B (v - u) of a velocity u, where v is the velocity at x and B an operator that may depend on x. B is the identity by default.
  /// If v is the solution of a linear system B v = w, the defect is w - B u, which takes one sum over the surface and no linear solve. `correction`
  /// and `jacobian_error` expect defects with the same B.
  virtual State defect(const State& x, const State& u) { return velocity(x) - u; }

  /// Returns true if velocity() requires a linear solve but defect() does not.
  virtual bool defect_spares_system() const { return false; }

  /// Returns the result of `solve` for r = shift (v - u), where v is the velocity at the current shape and u a given velocity. `defect`: B (v - u),
  /// as returned by defect(), with the operator B explained there. The defect can often be computed without v.
  virtual State correction(double shift, const State& defect, double tolerance, const Secants& secants) {
    return solve(shift, shift * defect, tolerance, secants);
  }

  /// Returns B (dv - J delta), the error of the Jacobian J of the last linearisation. Here dv is the change of the velocity due to the displacement
  /// delta, and B is the operator of `defect`. Used by Secants. `change`: change of the defect B (v - u) due to delta, where u = (x - c)/shift with a
  /// constant net c. If B is the identity, `change` is dv - delta/shift.
  virtual State jacobian_error(const State& change, const State& delta, double shift) { return change + delta / shift; }

  /// Improves the initial guess y of a stage with the shift gamma dt: displaces membranes that nearly conserve area, so that their local area is the
  /// same as in the shape `before` the stage.
  virtual void improve_start(State& /*y*/, const State& /*before*/, double /*shift*/) {}

  /// Removes the asymmetric round-off from a rate of change if the scene is symmetric. velocity() returns symmetric rates, but a difference of shapes
  /// contains asymmetric round-off. Extrapolated from such differences, the round-off would grow from step to step.
  virtual State symmetric(State rate) const { return rate; }

  // The functions below are used by searches for steady shapes and periodic motions, and by the computation of spectra.

  /// Returns J delta at x, where the velocity is v and the norm of delta is comparable to the size of the shape. Uses the frozen operators (4.3) if
  /// there are any, and otherwise a finite difference of velocities, which takes one evaluation. May call linearise(x).
  virtual State derivative(const State& x, const State& v, const State& delta) { return difference(x, v, delta); }

  /// Returns the change of the mesh relaxation velocity along interfaces due to the displacement delta, at the last linearisation. Returns an absent
  /// vector if no mesh relaxes.
  virtual State mesh_motion(const State& /*delta*/) { return {}; }

  /// Returns fields that move points along surfaces without changing the shape: rotations of the meshes of drops and of membranes (4.22).
  virtual std::vector<State> relabellings(const State& /*x*/) { return {}; }

 protected:
  /// Returns (v(x + e delta) - v)/e, where e delta has the norm 1e-4. This displacement is large enough to exceed the noise of adaptive quadrature
  /// and small enough for v to be nearly linear.
  State difference(const State& x, const State& v, const State& delta) {
    const double e = 1e-4 / norm(delta);
    return (velocity(x + e * delta) - v) / e;
  }
};

}  // namespace tanktread::coupling
