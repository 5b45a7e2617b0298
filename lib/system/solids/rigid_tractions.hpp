#pragma once
// Several rigid bodies without other particles, solved by the tractions on all of them.

#include <optional>
#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "base/dense_factors.hpp"
#include "base/types.hpp"
#include "membrane/mass.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "stokes/flow/ambient_flow.hpp"
#include "stokes/layer.hpp"
#include "stokes/medium/plane_wall.hpp"
#include "system/collocation.hpp"
#include "system/particle.hpp"
#include "system/ranks.hpp"
#include "system/solids/rigid_motion.hpp"
#include "system/solids/solid_response.hpp"
#include "system/solids/tube.hpp"
#include "system/solvers/krylov.hpp"
#include "system/solvers/options.hpp"

namespace tanktread::coupling {

/// The first-kind equation on all surfaces, with the force density f on the fluid:
///
///   (1/mu) sum_q A_pq f_q = U_p + Omega_p x r - v_inf   on body p,     int f_p dG = F_p,   int r x f_p dG = T_p                  (2.40)
///
/// where either the motion U_p, Omega_p or the force F_p and torque T_p of each body is given. A_pq is the single layer of body q at body p. The
/// operator is assembled at every position, made regular by one flux condition per body as in (2.10), and factored, so that films cost no iterations.
/// f is a sum of the densities z_k that unit motions of the bodies require, and the density that the ambient flow requires.
///
/// The collocation error of the force or torque that belongs to z_k is corrected by the reciprocal theorem (2.11): int z_k.(v - (1/mu) A f) dG over
/// all bodies is added, with v the right-hand side. The error of a stresslet is corrected in the same way with the densities of unit strains of its
/// body, except in a tube. The remaining errors of forces are products of the errors of f and z_k. In (2.23) they are linear in the error of one
/// density. The matrix is dense, which limits the number of control points to a few thousand.
///
/// On a lattice, A includes all images. Among solids, their response (2.47) is part of A, and the flow without bodies part of v_inf. In a tube, mu
/// times the response of the wall and the pressure drop is subtracted from A. These additions are smooth. Each density is therefore found by a few
/// iterations, and the preconditioner is the factored operator without these additions. The pressure drop of a duct flow is corrected like a force;
/// this correction includes the interpolation error of v_inf (2.41).
class RigidTractions {
 public:
  /// `space`: common space of all bodies, in their order. `rest`: net of the bodies. `tube`: surrounding tube, or null. References must outlive this
  /// object.
  RigidTractions(const spline::Space& space, const Net& rest, std::span<const Particle> particles, double viscosity,
                 const quadrature::Options& quadrature, const SolverOptions& solvers, const std::optional<stokes::PlaneWall>& wall, Tube* tube,
                 Ranks& ranks);

  /// Sets the lattice on which the bodies repeat, for all later calls.
  void repeat(const stokes::PeriodicCell& cell);

  /// Sets the solids in the lattice, which must outlive this object.
  void put_among(SolidResponse& solids) { around_.solids = &solids; }

  struct Body {
    RigidMotion motion;
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  ///< force and torque (about the centre) on the fluid
    Mat3 moment = Mat3::Zero();                        ///< first moment int f r dG, without the correction of moment()
  };

  /// Solves for the densities and motions of the bodies with net x, for which the tube, if any, must have been set. `centres`: centres of the bodies.
  /// `driven`: their prescribed forces and torques, or motions. Results are kept until the next call. Collective.
  void solve(const Net& x, std::span<const Vec3> centres, std::span<const Rigid> driven, const stokes::AmbientFlow& flow);

  const std::vector<Body>& bodies() const { return bodies_; }

  /// Returns int f r dG of a body for the latest solve. Its symmetric traceless part is corrected for the collocation error. The correction takes
  /// five additional solves, one for each unit strain. In a tube no part is corrected. Collective.
  Mat3 moment(std::size_t p);

  const Net& density() const { return density_; }  ///< control values of f
  double lacking_pressure() const { return lacking_pressure_; }         ///< correction of the pressure drop (2.7), for all bodies together
  const std::vector<SolveReport>& reports() const { return reports_; }  ///< reports of the iterative solves of the latest call of `solve` or `moment`
  stokes::Evaluations kernel_evaluations() const { return layer_.evaluations() + between_layer_.evaluations(); }

 private:
  /// Tube around the bodies, and solids among which they are; null if there are none.
  struct Surroundings {
    Tube* tube = nullptr;
    SolidResponse* solids = nullptr;
  };
  Eigen::MatrixXd system();
  void factor();
  Eigen::MatrixXd densities(const Eigen::MatrixXd& velocities);
  void make_regular(const Net& x, const Net& at);
  Net images_of(const Net& f);
  Net flow_at(const Net& at, const stokes::AmbientFlow& flow);
  Net by_solids(const Net& at, const Solids::Flow& flow);
  Eigen::VectorXd motions(const Eigen::MatrixXd& resistance, const Eigen::VectorXd& held, std::span<const Rigid> driven) const;
  Net left_over(const Net& x, const Net& f, const Net& v, const Net& flow);

  std::span<const Particle> particles_;
  double viscosity_;
  Surroundings around_;
  Ranks& ranks_;
  std::vector<int> own_points_;
  BetweenSites between_;
  stokes::Layer layer_, between_layer_;  // single layer at the collocation sites; single layer at Gauss points
  Eigen::SparseMatrix<double> sites_;
  membrane::MassMatrix mass_;
  bool repeats_ = false;
  Krylov krylov_;
  double tolerance_;
  std::vector<int> free_;  // indices, six per body, of the motions that are not prescribed
  Net flux_, outward_;     // flux vector b of each body; a velocity field with nonzero flux, divided by this flux (2.10)
  Eigen::MatrixXd alone_;  // system matrix without the response of the tube; kept only in a tube
  std::optional<DenseFactors> factors_;  // LU factors of `alone_`
  Net at_;                               // positions of the sites in the latest call of `solve`
  Eigen::VectorXd left_;                 // int N_A (v - v_inf - (1/mu) A f) dG, the residual of (2.40) with the density f of this call, from which
                                         // (2.11) computes corrections
  std::vector<Vec3> centres_;
  std::vector<Body> bodies_;
  Net density_;
  double lacking_pressure_ = 0;
  std::vector<SolveReport> reports_;
};

}  // namespace tanktread::coupling
