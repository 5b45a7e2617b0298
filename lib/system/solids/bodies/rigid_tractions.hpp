#pragma once
// Integral equation of the first kind for the tractions on rigid bodies, also among deformable particles.

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "membrane/mass.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "stokes/flow/ambient_flow.hpp"
#include "stokes/medium/medium.hpp"
#include "system/solids/bodies/body_layer.hpp"
#include "system/rigid_motion.hpp"
#include "system/solids/bodies/rigid_residual.hpp"
#include "system/system.hpp"

namespace tanktread::coupling {

/// Returns the parameters of a single body. The options of `Solvers/traction` replace the options of `Solvers/velocity`. `medium`: null if there is
/// none.
CapsuleParameters single_body(const spline::Space& space, double radius, double viscosity, const quadrature::Options& quadrature,
                              const SolverOptions& solvers, std::shared_ptr<const stokes::Medium> medium = nullptr);

/// The first-kind equation on the surfaces of all rigid bodies, with the force density f on the fluid:
///
///   (1/mu) sum_q A_pq f_q = U_p + Omega_p x r - v_inf   on body p,     int f_p dGamma = F_p,   int r x f_p dGamma = T_p          (2.40)
///
/// where either the motion U_p, Omega_p or the force F_p and torque T_p of each body is given. A_pq is the single layer of body q at body p. The
/// operator is assembled at every position, made regular by one flux condition per body as in (2.10), and factored. Thin films between bodies
/// therefore cost no additional iterations. f is a sum of the densities z_k that unit motions of the bodies require, and the density that the ambient
/// flow requires.
///
/// The collocation error of the force or torque that belongs to z_k is corrected by the reciprocal theorem (2.11): int z_k.(v - (1/mu) A f) dGamma
/// over all bodies is added, with v the right-hand side. moment() corrects the error of a stresslet in the same way with the densities of unit
/// strains of its body, except in a tube. The remaining errors of forces are products of the errors of f and z_k. With the double-layer equation
/// (2.23), the errors of forces are linear in the error of one density. In a channel the residual on the wall is included (2.42) if all particles
/// are rigid. The matrix is dense, which limits the number of control points to a few thousand.
///
/// The fluid may have other boundaries: images on a lattice, the wall of a tube and its pressure drop, plates and posts (2.47), and deformable
/// particles. These boundaries change the solution as follows:
/// - A includes the velocity that f causes through the boundaries, and v_inf includes the flow that they cause without bodies. The additions to A are
///   smooth, and A remains self-adjoint. Drops and capsules of viscosity ratio 1 without surface viscosity do not change A.
/// - The matrix with the additions is not factored. GMRES finds the densities, together with the velocity of deformable particles (2.52). Its
///   preconditioner is the factored operator of the bodies without the additions.
/// - The pressure drop of a duct flow is corrected like a force, unless there are deformable particles. This correction includes the interpolation
///   error of v_inf (2.41).
class RigidTractions {
 public:
  /// `space`: common space of all particles. `unstressed`, `rest`: control nets of all particles, unstressed and at rest. `parameters`: see
  /// single_body() for a body without other particles. `walls`: must know the unstressed particles (Tube::set_particles). `own`: collocation
  /// points whose rows this rank computes. References, except `parameters`, and the walls must outlive this object.
  RigidTractions(const spline::Space& space, const Net& unstressed, const Net& rest, const CapsuleParameters& parameters, const FluidWalls& walls,
                 const std::vector<int>& own, const Ranks& ranks);

  /// Sets the periodic cell of the particles, for all later calls.
  void repeat(const stokes::PeriodicCell& cell);

  /// Interactions of the bodies with walls, with deformable particles and with images on a lattice: the system of all particles. Its unknowns y are
  /// the force densities f in rows of bodies (BodyTractions), and the velocity v in rows of deformable particles.
  struct Surroundings {
    std::shared_ptr<const System> system;
    std::vector<const Equation*> added;  ///< equations of the program in `system`; their unknowns are found together with the motions
    bool responds;  ///< true if the velocity on the bodies depends on y not only through the single layers of the bodies
  };

  /// Sets the control net x of all particles, and the centres of the bodies. If there is a tube, call Tube::set_shape(x) before. `around`:
  /// interactions with all other boundaries and particles; not set for an isolated body in unbounded fluid, in a medium or in a tube. Collective.
  void set_shape(const Net& x, std::span<const Vec3> centres, std::optional<Surroundings> around = {});

  /// Solution of (2.40) for all bodies at the net `shape`.
  struct Solution {
    Net shape;
    std::vector<SolvedBody> bodies;  ///< in the order of the particles; the moments are not corrected for the collocation error, see moment()
    Net unknowns;                    ///< control values of f on bodies, and of v on deformable particles
    Eigen::VectorXd added;           ///< unknowns of the added equations (Surroundings::added), as numbers of their blocks
    double pressure_correction = 0;  ///< collocation-error correction of the pressure drop (2.7)
    Eigen::VectorXd residual;        ///< int N_A (v - v_inf - (1/mu) A f) dGamma over the bodies, flattened: residual of (2.40) that (2.11) uses; 0
                                     ///< in the rows of deformable particles
  };

  /// Solves for the force densities and motions of the bodies and the velocity of the deformable particles at the net x. `driven`: prescribed force
  /// and torque, or prescribed motion, of each body. `flow`: ambient flow. `centres`, `around`: as for set_shape(). Returns solution(). Collective.
  const Solution& solve(const Net& x, std::span<const Vec3> centres, std::span<const RigidDrive> driven, const stokes::AmbientFlow& flow,
                        std::optional<Surroundings> around = {});

  const Solution& solution() const { return solution_; }  ///< returns the solution that solve() computed last

  /// Returns the force densities, shape (N, 3), that cause these velocities at the collocation sites of the net passed to set_shape() last. Neither
  /// motions of the bodies nor corrections of the collocation error are included. All particles must be bodies. Collective.
  Net density(const Net& velocities);

  /// Returns the correction (2.41) of the pressure drop for the collocation error. `f`: force density on freely moving bodies at the net x. `v`:
  /// control values of the bodies' velocity. `slower`: multiple of the flow of the empty duct that is subtracted from `flow`. `z`: force density due
  /// to the flow of the empty duct, of amplitude 1, on bodies at rest; for bodies without forces and torques in this flow, -f has the same effect.
  /// All particles must be bodies. Collective.
  double pressure_correction_of(const Net& x, const Net& f, const Net& v, const stokes::AmbientFlow& flow, double slower, const Net& z);

  /// Returns the integrals of the force density f over body p, without collocation-error corrections. The motion is not set.
  SolvedBody integrals(std::size_t p, const Net& f);

  /// Returns the velocity that the load f on a lone body causes at its sites, with the response of a tube. f and the velocity have components in axes
  /// that turn with the body, by `turn` since the net that was set last. Collective.
  Net caused(const Net& load, const Mat3& turn = Mat3::Identity());

  /// Returns the positions of the collocation sites of all particles on the net passed to set_shape() last.
  const Net& sites() const { return sites_; }

  BodyLayer& layer() { return layer_; }  ///< returns the single layer on the net passed to set_shape() last

  /// Returns whether the bodies with the net x are inside the tube, which is set to x, and in the medium. Collective.
  bool inside(const Net& x) const;

  /// Returns int f r dGamma of body p for solution(), whose net must be the net set last. Unless there is a tube, its symmetric traceless
  /// part is corrected for the collocation error. This takes five additional solves, one for each unit strain. Collective.
  Mat3 moment(std::size_t p);

  bool all_rigid() const;  ///< returns whether all particles are rigid bodies
  const std::vector<SolveReport>& reports() const { return reports_; }  ///< reports of the iterative solves of the latest call of `solve` or `moment`
  /// Throws RunFailure if an iterative solve in `reports()` did not converge. Otherwise returns the number of iterations of all these solves.
  int converged_iterations() const;
  /// Solves the given linear system for a traction. `unknowns`: initial guess, replaced by the solution. Returns the number of iterations. If the
  /// solve does not converge, throws RunFailure and leaves `unknowns` unchanged. Collective.
  int solve_iteratively(const LinearSystem& system, const Eigen::VectorXd& right, Eigen::VectorXd& unknowns);
  Tube* tube() const { return walls_.tube; }
  stokes::Evaluations kernel_evaluations() const;  ///< number for the layers of the bodies, the residual and the walls

 private:
  Eigen::MatrixXd densities(const Eigen::MatrixXd& velocities);
  bool responds() const { return around_ ? around_->responds : walls_.any(); }
  Net product(const Net& y);
  Net force_densities(const Net& y) const;
  Net completed(const Eigen::VectorXd& y);
  Net load(const Net& y, const Eigen::VectorXd& added = {}) const;
  Eigen::Index n_added() const { return around_ ? around_->system->unknowns()->size() - x_.size() : 0; }
  BlockVector with_added(const Net& y, const Eigen::VectorXd& added) const;
  BlockVector unit_of_added(Eigen::Index k) const;
  void set_units(Eigen::Ref<Eigen::MatrixXd> right, Eigen::MatrixXd& fields);
  void add_equations(const Eigen::MatrixXd& fields, const Eigen::MatrixXd& of_all, Eigen::MatrixXd& resistance, Eigen::VectorXd& at_rest);
  Eigen::VectorXd rows_of_added(const Net& v, const Eigen::VectorXd& added, Given given) const;
  Eigen::VectorXd corrections(const Net& y, const Eigen::MatrixXd& z, const Eigen::VectorXd& residual);

  std::vector<Particle> particles_;  // the bodies
  FluidWalls walls_;
  std::shared_ptr<const stokes::Medium> medium_;
  BodyLayer layer_;
  RigidResidual residual_;
  Eigen::SparseMatrix<double> collocation_;  // collocation matrix R
  membrane::MassMatrix mass_;
  bool repeats_ = false;
  Krylov krylov_;
  double tolerance_;
  std::optional<Surroundings> around_;  // surroundings passed to set_shape() last
  Net x_, sites_;                       // x_: net passed to set_shape() last. sites_: positions of the collocation sites on this net
  std::vector<Vec3> centres_;
  Solution solution_;
  std::vector<SolveReport> reports_;
};

}  // namespace tanktread::coupling
