#pragma once
// A single rigid body, free or driven by a given force and torque, and its motion in an unbounded flow.

#include <vector>

#include "base/types.hpp"
#include "stokes/flow/ambient_flow.hpp"
#include "system/dynamics.hpp"
#include "system/particle.hpp"
#include "system/rigid_motion.hpp"
#include "system/solids/bodies/rigid_tractions.hpp"

namespace tanktread::coupling {

/// Returns matrix k = 0 .. 4 of a basis of the strain rates (trace-free symmetric matrices).
Mat3 unit_strain(int k);

/// Returns the trace-free symmetric matrix E whose products E : unit_strain(k), k = 0 .. 4, are `products`.
Mat3 strain_of_products(const Eigen::Matrix<double, 5, 1>& products);

/// Force densities that cause given velocities on the body: the six unit rigid motions, the five unit strains and, if `quadratic`, the 18 fields y_j
/// y_k e_i with y = x - centre. Components are along the coordinate axes in which the net `surface` is given. The force density in any affine flow is
/// a combination of the first eleven, and in a quadratic flow (2.20) a combination of all twenty-nine.
struct RigidModes {
  RigidModes(RigidTractions& body, const Net& surface, const Vec3& centre, bool quadratic);

  std::vector<Net> density;                     ///< force densities on the fluid: translations, rotations, strains, quadratic fields
  Eigen::Matrix<double, 6, Eigen::Dynamic> response;  ///< force and torque on the fluid, one column per entry of `density`
  std::vector<Mat3> stresslet;                  ///< stresslet of each entry of `density`
};

/// Returns the state of a rigid body in its initial orientation. A state has two blocks: "position", the centre, and "orientation", the vector part
/// and the scalar part of the quaternion that rotates the body from its initial orientation.
State placed(const Vec3& centre);
Vec3 centre_of(const State& position);
Eigen::Quaterniond orientation_of(const State& position);
Mat3 rotation_of(const State& position);

/// Centre and orientation of a single rigid body as a system dx/dt = v(x).
class LoneRigidBody : public Dynamics {
 public:
  /// `surface`: control net of the body in its initial position. `radius`: particle radius R_C. `driven`: given force on the body, and torque about
  /// its centre.
  LoneRigidBody(const Net& surface, const Vec3& centre, double radius, const stokes::AmbientFlow& flow, const RigidDrive& driven)
      : surface_(surface), centre_(centre), radius_(radius), flow_(flow), driven_(driven) {}

  void set_time(double time, double start) override { flow_.set_time(time, start); }
  double next_kink(double time) const override { return flow_.next_kink(time); }
  const stokes::AmbientFlow& flow() const { return flow_; }  ///< flow at the time set last
  State velocity(const State& position) override;
  void restore_constraints(State& position) override;              ///< normalises the quaternion; the volume of a rigid body needs no correction
  double norm(const State& displacement) const override;            ///< combines the displacement of the centre, divided by R_C, and the angle of
                                                                  ///< rotation

  virtual RigidMotion motion(const State& position) const = 0;
  virtual Net force_density(const State& position) const = 0;  ///< force density on the fluid, control values
  virtual Mat3 stresslet(const State& position) const = 0;     ///< int [(t_i x_j + t_j x_i)/2 - delta_ij t.x/3] dGamma; t: traction on the body
  virtual double pressure_drop(const State&) const { return 0; }  ///< additional pressure drop due to the body, in a tube

  /// Returns the latest solution of the linear system; empty if no system is solved iteratively. The next solve starts from this solution.
  /// Checkpoints store it, so that a resumed run is bitwise equal to an uninterrupted run.
  virtual Eigen::VectorXd unknowns() const { return {}; }
  virtual void start_from(const Eigen::VectorXd&) {}

  virtual long linear_solves() const = 0;               ///< number of linear systems solved for the motion
  virtual long solver_iterations() const { return 0; }  ///< number of iterations of the linear solver since construction

  Net surface(const State& position) const { return moved(surface_, position); }  ///< control net of the surface in the laboratory frame
  const Vec3& centre() const { return centre_; }  ///< centre at the initial position
  long evaluations() const { return evaluations_; }

 protected:
  Net moved(const Net& x, const State& position) const;  ///< returns points of the body in its initial position, moved to `position`

  Net surface_;
  Vec3 centre_;
  double radius_;
  stokes::AmbientFlow flow_;  // flow at the time set last
  RigidDrive driven_;

 private:
  long evaluations_ = 0;
};

/// A free body in unbounded flow (2.20):  U = v_inf(x_c) + U',  dq/dt = (0, Omega) q/2,  Omega = curl v_inf(x_c)/2 + Omega'. Here x_c is the centre
/// and q the quaternion of the orientation. (U', Omega') follows from the given force and torque (0 by default), and from the strain rate and the
/// second derivatives of v_inf at x_c. A call costs only a few products of small matrices.
class FreeBody : public LoneRigidBody {
 public:
  FreeBody(RigidTractions& body, const Net& surface, const Vec3& centre, double radius, const stokes::AmbientFlow& flow,
           const RigidDrive& driven = {});

  RigidMotion motion(const State& position) const override;
  Net force_density(const State& position) const override;
  Mat3 stresslet(const State& position) const override;
  long linear_solves() const override { return modes_.response.cols(); }

 private:
  Eigen::VectorXd amplitudes(const State& position) const;

  RigidModes modes_;
  Eigen::Matrix<double, 6, 6> mobility_;            ///< column k: rigid motion due to the unit force (k = 0, 1, 2) or unit torque (k = 3, 4, 5)
  Eigen::Matrix<double, 6, Eigen::Dynamic> drift_;  ///< column k: motion of a free body in unit flow k, relative to this flow. Flows: unit strains,
                                                    ///< then unit quadratic flows
};

}  // namespace tanktread::coupling
