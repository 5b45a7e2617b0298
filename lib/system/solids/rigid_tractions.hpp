#pragma once
// Several rigid bodies and nothing else, by the tractions on all of them.

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
#include "system/solids/tube.hpp"
#include "system/solvers/krylov.hpp"
#include "system/solvers/options.hpp"

namespace tanktread::coupling {

/// The first-kind equation of all surfaces, f the force density on the fluid:
///
///   (1/mu) sum_q A_pq f_q = U_p + Omega_p x r - v_inf   on body p,     int f_p dG = F_p,   int r x f_p dG = T_p                  (2.40)
///
/// with one motion or force and torque given of each body. At every place it is assembled, made regular by a flux of each body as in (2.10), and
/// factored: a film takes no iterations. f is a sum of the densities z_k of unit motions and of that of the flow. What collocation lacks of a force
/// or torque is, by the reciprocal theorem (2.11), int z_k.(v - (1/mu) A f) dG over all bodies, and of a stresslet with the z of its body's unit
/// strains, but in a tube: they err by the product of two errors of densities, where those of (2.23) err by one. Dense: some thousands of points.
///
/// On a lattice A is that of all images, in a tube less mu times what wall and pressure drop answer: what they add is smooth, so a few iterations
/// around the factors of the bodies alone solve for each density. The pressure drop
/// of a duct's flow lacks as a force does, and what is left of v_inf where it is interpolated (2.41).
class RigidTractions {
 public:
  /// `space`: of all bodies, that lie in it in their order. `rest`: their net. `tube`: around them, or none. What is referred to outlives this.
  RigidTractions(const spline::Space& space, const Net& rest, std::span<const Particle> particles, double viscosity,
                 const quadrature::Options& quadrature, const SolverOptions& solvers, const std::optional<stokes::PlaneWall>& wall, Tube* tube,
                 Ranks& ranks);

  /// On a lattice, from now on.
  void repeat(const stokes::PeriodicCell& cell);

  struct Body {
    RigidMotion motion;
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  ///< on the fluid, about the centre
    Mat3 moment = Mat3::Zero();                        ///< int f r dG, as it is
  };

  /// Of bodies with net x, where the tube has them placed, and these centres that are driven so; kept until the next call. Collective.
  void solve(const Net& x, std::span<const Vec3> centres, std::span<const Rigid> driven, const stokes::AmbientFlow& flow);

  const std::vector<Body>& bodies() const { return bodies_; }

  /// int f r dG of a body of the latest call, with what its symmetric part lacks but for the trace, which takes five more systems; in a tube as it
  /// is. Collective.
  Mat3 moment(std::size_t p);

  const Net& density() const { return density_; }  ///< control values of f
  double lacking_pressure() const { return lacking_pressure_; }         ///< what (2.7) lacks, of all copies
  const std::vector<SolveReport>& reports() const { return reports_; }  ///< of the systems of the latest call of either, if there were any
  stokes::Evaluations kernel_evaluations() const { return layer_.evaluations() + between_layer_.evaluations(); }

 private:
  Eigen::MatrixXd system();
  void factor();
  Eigen::MatrixXd densities(const Eigen::MatrixXd& velocities);
  void make_regular(const Net& x, const Net& at);
  Net images_of(const Net& f);
  Eigen::VectorXd motions(const Eigen::MatrixXd& resistance, const Eigen::VectorXd& held, std::span<const Rigid> driven) const;
  Net left_over(const Net& x, const Net& f, const Net& v, const Net& flow);

  std::span<const Particle> particles_;
  double viscosity_;
  Tube* tube_;
  Ranks& ranks_;
  std::vector<int> own_points_;
  BetweenSites between_;
  stokes::Layer layer_, between_layer_;  // at the collocation sites, and between them
  Eigen::SparseMatrix<double> sites_;
  membrane::MassMatrix mass_;
  bool repeats_ = false;
  Krylov krylov_;
  double tolerance_;
  std::vector<int> free_;  // numbers, six a body, of motions that are not given
  Net flux_, outward_;     // b of each body, and a velocity with a flux over that flux
  Eigen::MatrixXd alone_;  // the system without what a tube answers, kept in one
  std::optional<DenseFactors> factors_;  // of that
  Net at_;                               // the sites, and of the density there what it leaves over
  Eigen::VectorXd left_;
  std::vector<Vec3> centres_;
  std::vector<Body> bodies_;
  Net density_;
  double lacking_pressure_ = 0;
  std::vector<SolveReport> reports_;
};

}  // namespace tanktread::coupling
