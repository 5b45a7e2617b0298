#pragma once
// Motion of a single free body in a tube or in a medium.

#include "base/types.hpp"
#include "system/solids/bodies/rigid_body.hpp"

namespace tanktread::coupling {

/// A free body in fluid with boundaries, where equation (2.40) of the traction is solved at each position. Calls are collective. Repeated calls at
/// one position take one solve. If the body is not inside the fluid, the motion is NaN.
class BoundedFreeBody : public LoneRigidBody {
 public:
  void set_time(double time, double start) override {
    if (flow_.set_time(time, start)) position_ = {};
  }
  std::string why_undefined() const override { return "the body would cross the wall"; }
  RigidMotion motion(const State& position) const override { return solution(position).motion; }
  Net force_density(const State& position) const override { return solution(position).density; }
  Mat3 stresslet(const State& position) const override { return solution(position).stresslet; }
  long linear_solves() const override { return solves_; }

 protected:
  struct Solution {
    RigidMotion motion;
    Net density;
    Mat3 stresslet;
    double slower = 0;  // fraction of the flow of the duct that is subtracted, because the collocation error changes a prescribed pressure drop
  };

  /// `body`: equation (2.40) of the traction on the body. `surface`: net of the body in its initial position.
  BoundedFreeBody(RigidTractions& body, const Net& surface, const Vec3& centre, double radius, const stokes::AmbientFlow& flow,
                  const RigidDrive& driven)
      : LoneRigidBody(surface, centre, radius, flow, driven), body_(body) {}

  static Solution outside_fluid(const Net& x);          ///< returns NaN for the motion and all other quantities
  const Solution& solution(const State& position) const;  ///< returns solve(), or the result of its latest call if that was for the same position

  RigidTractions& body_;
  mutable long solves_ = 0;  // number of systems solved

 private:
  virtual Solution solve(const State& position) const = 0;

  mutable State position_;       // state of the body (centre and quaternion, see placed()) at the latest solve; empty if there is no valid solution
  mutable Solution solution_;  // solution at `position_`
};

/// A free body in a medium such as that in front of a plane wall, or in unbounded fluid.
class FreeBodyInMedium : public BoundedFreeBody {
 public:
  FreeBodyInMedium(RigidTractions& body, const Net& surface, const Vec3& centre, double radius, const stokes::AmbientFlow& flow,
                   const RigidDrive& driven = {})
      : BoundedFreeBody(body, surface, centre, radius, flow, driven) {}

 private:
  Solution solve(const State& position) const override;
};

/// A free body in a tube. The force density f and the motion (U, Omega) are the unknowns of one system in body-fixed axes,
///
///   (1/mu) A f - u(f) - (U + Omega x r) = -v_inf   on the body,    int f dGamma = F,   int r x f dGamma = T,
///
/// where u(f) is the velocity that wall and pressure drop cause for the load f (Tube::respond), and F, T are the given force and torque. The single
/// layer A does not depend on the position. The preconditioner is the inverse of the system without the term u(f). The initial guess is the previous
/// solution.
class FreeBodyInTube : public BoundedFreeBody {
 public:
  /// `body`: equation of the traction on the body in a tube; no other object may set its shape later.
  FreeBodyInTube(RigidTractions& body, const Net& surface, const Vec3& centre, double radius, const stokes::AmbientFlow& flow, double viscosity,
                 const RigidDrive& driven = {});

  double pressure_drop(const State& position) const override;
  Eigen::VectorXd unknowns() const override { return unknowns_; }
  void start_from(const Eigen::VectorXd& unknowns) override { unknowns_ = unknowns; }
  long solver_iterations() const override { return iterations_; }

 private:
  Solution solve(const State& position) const override;
  Solution in_body_axes(const State& position, double slower) const;
  double pressure_correction(const State& position, const Solution& found) const;
  Net density_at_rest(const State& position, const Net& velocities) const;

  double viscosity_;
  RigidModes modes_;                  // force densities for unit motions and unit flows, without the effect of the tube
  mutable Eigen::VectorXd unknowns_;  // traction and rigid motion found by the latest solve, from which the next solve starts
  mutable long iterations_ = 0;
};

}  // namespace tanktread::coupling
