#pragma once
// A rigid body that a given force and torque act on, or none, carried by an unbounded flow, in a tube or beside a plane wall.

#include <vector>

#include "base/types.hpp"
#include "stokes/flow/ambient_flow.hpp"
#include "system/dynamics.hpp"
#include "system/particle.hpp"
#include "system/solids/resistance.hpp"
#include "system/solids/rigid_motion.hpp"

namespace tanktread::coupling {

/// A basis of the strains, trace-free symmetric matrices, k = 0 to 4.
Mat3 unit_strain(int k);

/// The strain E that has these products E : unit_strain(k).
Mat3 strain_of_products(const Eigen::Matrix<double, 5, 1>& products);

/// Resistance to the six rigid motions, the five strains of unit size and, where `quadratic`, the fields y_j y_k e_i with y = x - centre, in the axes
/// that the body has in `surface`. Whatever an affine flow does to the body is a combination of the first eleven solutions, whatever a flow (2.20)
/// does one of all twenty-nine.
struct RigidModes {
  RigidModes(Resistance& body, const Vec3& centre, bool quadratic);

  std::vector<Net> density;                     ///< force densities on the fluid: translations, rotations, strains, quadratic fields
  Eigen::Matrix<double, 6, Eigen::Dynamic> response;  ///< force and torque of each
  std::vector<Mat3> stresslet;                  ///< of each
};

/// Where a rigid body is, as a net of three rows: the centre; the vector and, first in its row, the scalar part of the quaternion that turns the
/// body from its initial place.
Net placed(const Vec3& centre);
Vec3 centre_of(const Net& place);
Mat3 rotation_of(const Net& place);

/// Centre and orientation of a rigid body as dx/dt = v(x).
class LoneRigidBody : public Dynamics {
 public:
  /// `surface`: control net of the body at its initial place; `radius`: R_C; `driven`: by which force, and torque about the centre.
  LoneRigidBody(const Net& surface, const Vec3& centre, double radius, const stokes::AmbientFlow& flow, const Rigid& driven)
      : surface_(surface), centre_(centre), radius_(radius), flow_(flow), driven_(driven) {}

  void at(double time, double start) override { flow_.at(time, start); }
  double next_kink(double time) const override { return flow_.next_kink(time); }
  Net velocity(const Net& place) override;
  void freeze(const Net&) override {}
  void linearise(const Net&) override {}
  Net solve(double, const Net& r, double, const Secants&) override { return r; }  ///< J = 0: the motion is not stiff
  Net missed(const Net& dv, const Net&) override { return dv; }
  void restore_volume(Net& place) override;                       ///< a rigid body has its volume; here the quaternion gets back its length
  double norm(const Net& displacement) const override;            ///< displacement of the centre over R_C and angle, as one length

  virtual RigidMotion motion(const Net& place) const = 0;
  virtual Net force_density(const Net& place) const = 0;  ///< on the fluid, control values
  virtual Mat3 stresslet(const Net& place) const = 0;     ///< int (t_i x_j + t_j x_i)/2 - delta_ij/3 t.x dG, t the traction on the body
  virtual double pressure_drop(const Net&) const { return 0; }  ///< that the body adds, in a tube

  /// The latest solution, from which the iterative solver starts the next one. A checkpoint holds it, so that a resumed run is the same to the last
  /// bit. Both are empty if no iterative solver is used.
  struct Start {
    Net place;                 ///< where the body was
    Eigen::VectorXd unknowns;  ///< of the linear system there
  };
  virtual Start start() const { return {}; }
  virtual void start_from(const Start&) {}
  virtual void forget_recycled() const {}  ///< discards the products that the preconditioner `recycled` keeps from earlier solves

  Net surface(const Net& place) const;            ///< control net of the surface in space
  const Vec3& centre() const { return centre_; }  ///< at the initial place
  long evaluations() const { return evaluations_; }

 protected:
  Net surface_;
  Vec3 centre_;
  double radius_;
  stokes::AmbientFlow flow_;  // at the time told last
  Rigid driven_;

 private:
  long evaluations_ = 0;
};

/// A free body in unbounded flow (2.20):  U = v_inf(x_c) + U',  dq/dt = (0, Omega) q/2,  Omega = curl v_inf(x_c)/2 + Omega', where (U', Omega')
/// makes force and torque what they are, or vanish, in what else the flow is about x_c. A few small matrices a call.
class FreeBody : public LoneRigidBody {
 public:
  FreeBody(Resistance& body, const Vec3& centre, double radius, const stokes::AmbientFlow& flow, const Rigid& driven = {});

  RigidMotion motion(const Net& place) const override;
  Net force_density(const Net& place) const override;
  Mat3 stresslet(const Net& place) const override;

 private:
  Eigen::VectorXd amplitudes(const Net& place) const;

  RigidModes modes_;
  Eigen::Matrix<double, 6, 6> mobility_;            ///< rigid motion of unit forces and torques
  Eigen::Matrix<double, 6, Eigen::Dynamic> drift_;  ///< rigid motion relative to the flow, for each strain and quadratic field
};

/// A free body in a tube, or beside a plane wall: at each place the traction and the rigid motion are solved for together,
///
///   (1/mu) A f - u(f) - (U + Omega x r) = -v_inf   on the body,    int f dG = F,   int r x f dG = T,
///
/// with u the answer of wall and pressure drop; Belos starts from the solution before. Beside a plane wall A has its images, the unit motions are
/// solved for one by one, and what force and torque of f lack is made up for (2.11). Calls are collective, and those at one place after another cost
/// one solve. The motion is not finite where the body reaches into the wall.
class FreeBodyInTube : public LoneRigidBody {
 public:
  /// `body`: with its tube or wall. `solvers`: of the system above.
  FreeBodyInTube(Resistance& body, const Vec3& centre, double radius, const stokes::AmbientFlow& flow, double viscosity,
                 const SolverOptions& solvers, const Rigid& driven = {});

  void at(double time, double start) override {
    if (flow_.at(time, start)) place_ = {};
  }
  RigidMotion motion(const Net& place) const override { return solution(place).motion; }
  Net force_density(const Net& place) const override { return solution(place).density; }
  Mat3 stresslet(const Net& place) const override { return solution(place).stresslet; }
  double pressure_drop(const Net& place) const override;
  Start start() const override { return {place_, unknowns_}; }
  void start_from(const Start& start) override;
  void forget_recycled() const override;
  long solver_iterations() const { return iterations_; }

 private:
  struct Solution {
    RigidMotion motion;
    Net density;
    Mat3 stresslet;
  };
  const Solution& solution(const Net& place) const;
  void keep(const Net& place, const Net& f, const RigidMotion& own) const;
  void solve_in_tube(const Net& place) const;
  Net density_of_unknowns() const;
  RigidMotion motion_of_unknowns() const;
  void solve_beside_wall(const Net& place, Net& f, RigidMotion& own) const;

  Resistance& body_;
  double viscosity_;
  Krylov krylov_;
  double tolerance_;
  mutable Net place_;  // the last one, its solution, and the unknowns it is made of
  mutable Solution solution_;
  mutable Eigen::VectorXd unknowns_;
  mutable long iterations_ = 0;
};

}  // namespace tanktread::coupling
