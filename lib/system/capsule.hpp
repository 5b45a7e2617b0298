#pragma once
// Motion of capsules, drops and rigid bodies in Stokes flow, for the time integrators.

#include <memory>
#include <optional>
#include <vector>

#include "stokes/flow/ambient_flow.hpp"
#include "system/capsule_jacobian.hpp"
#include "system/capsule_parameters.hpp"
#include "system/evaluation.hpp"
#include "system/frozen/frozen_layers.hpp"
#include "system/velocity_solver.hpp"

namespace tanktread::coupling {

/// Computes dx/dt = v(x) for the stacked control nets x of all particles. VelocitySolver solves for v, and CapsuleJacobian is the Jacobian for
/// implicit steps. CoupledMotion integrates this motion together with the fields on the surfaces; its functions of the same names are described at
/// Dynamics.
///
/// Order of calls: set_time() sets the time. evaluate() solves for the loads and velocities of a shape and returns them as an Evaluation.
/// evaluate_on_demand() returns an Evaluation that solves only when a quantity is read that needs it. Implicit schemes call freeze() every few steps,
/// linearise() in each step. Schemes call restore_constraints() after a step.
class Capsule {
 public:
  /// `unstressed` and `resting`: control nets of the unstressed and of the resting surfaces, of shape (N, 3) on `space`. The motion conserves
  /// `kept_volume` of each particle if it is set, and otherwise the volume of the particle in `resting`.
  Capsule(const spline::Space& space, const Net& unstressed, const Net& resting, const stokes::AmbientFlow& flow,
          const CapsuleParameters& parameters, Phases& phases, std::unique_ptr<Tube> tube = nullptr);

  /// Evaluates the shape x: loads, unknowns and velocities. Returns the cached result if x is the shape evaluated last and forces and flow have not
  /// changed. `guess`: initial guess of the velocity for the linear solve; not used if there are rigid bodies. `error`: see Evaluation::solve.
  std::shared_ptr<Evaluation> evaluate(const Net& x, const Net& guess = {}, double error = 0);

  /// Returns an evaluation of the shape x that computes each quantity at its first use. `velocity`: velocity of the control points; no rows if
  /// unknown. If the shape evaluated last is within `distance` of x (in `norm`), the rigid motions and fluid velocities of that shape are used.
  /// Otherwise a linear system is solved when a quantity is needed that cannot be computed from `velocity`.
  std::shared_ptr<Evaluation> evaluate_on_demand(const Net& x, const Net& velocity, double distance);

  Net velocity(const Net& x) { return evaluate(x)->velocity(); }
  void set_time(double time, double start);

  /// Returns the defect (3.14) of a velocity u at the shape x, if defect_spares_system(); see Dynamics::defect.
  Net defect(const Net& x, const Net& u);
  bool defect_spares_system() const;

  void freeze(const Net& x);
  double frozen_bytes() const { return frozen_.bytes(); }
  bool lattice_moves() const { return parameters().cell && !solver_.walls().any(); }
  void linearise(const Net& x);
  Net mesh_motion(const Net& delta);
  void restore_constraints(Net& x);
  void improve_start(Net& y, const Net& before, double shift);
  std::vector<Net> relabellings(const Net& x);
  double distance(const Net& from, const Net& to) const;
  double norm(const Net& displacement) const;  ///< largest root mean square displacement of the control points of a particle, divided by its R_C

  /// Returns VelocitySolver::plan() at the shape evaluated last; empty if there is none.
  std::string plan() { return latest_ ? solver_.plan(latest_->x()) : std::string(); }

  using Forces = VelocitySolver::Forces;
  void set_forces(Net Forces::* of, Net work);  ///< sets one kind of additional forces for all later calls

  /// Returns the change of the velocity at the shape of `at` due to additional forces with the virtual work `work`. Linear in `work`.
  Net response(Evaluation& at, const Net& work);

  /// Discards the evaluation and the shape of the walls that are kept for the next call. A run discards them after each checkpoint, because a
  /// checkpoint does not contain them.
  void forget();

  /// Returns whether the shape evaluated last is within `distance` of x (in `norm`), apart from a translation along a straight tube that
  /// changes no load.
  bool evaluated_about(const Net& x, double distance) const;

  /// Returns the rigid bodies among the particles, at their positions in x.
  RigidParticles rigid_at(Net x) const {
    RigidParticles rigid = solver_.rigid();
    rigid.fit_to(x);
    return rigid;
  }

  VelocitySolver& solver() { return solver_; }
  Phases& phases() { return phases_; }
  CapsuleJacobian& jacobian() { return jacobian_; }
  bool has_frozen() const { return !frozen_.empty(); }
  bool slides() const { return solver_.slides(); }  ///< whether control points slide along an interface: their velocity is not the fluid velocity

  Eigen::Index n_points() const { return membrane().space().n_points; }
  const CapsuleParameters& parameters() const { return solver_.parameters(); }
  const surface::Symmetry& symmetry() const { return parameters().symmetry; }
  const std::vector<Particle>& particles() const { return solver_.particles(); }
  const membrane::Membrane& membrane() const { return solver_.membranes().membrane(); }
  const surface::Geometry& geometry() const { return solver_.volumes().geometry(); }
  double volume_error(double volume, std::size_t p = 0) const { return solver_.volumes().error(volume, p); }  ///< V/V0 - 1 of particle p
  Tube* tube() const { return solver_.walls().tube; }                                      ///< null if there is no tube
  SolidResponse* solids() const { return solver_.walls().solids; }                         ///< null if there are no plates or posts
  const stokes::AmbientFlow& flow() const { return solver_.flow(); }                       ///< flow at the time set by `set_time`
  const std::optional<stokes::PeriodicCell>& cell() const { return solver_.cell(); }       ///< cell at that time; not set without a lattice
  const VelocityProjection* projection() const { return solver_.targets().projection(); }  ///< null if velocities are collocated

  stokes::Evaluations kernel_evaluations() const { return solver_.kernel_evaluations() + frozen_.evaluations(); }
  const OperationCounts& counts() const { return solver_.counts(); }
  OperationCounts& counts() { return solver_.counts(); }

 private:
  Phases& phases_;
  VelocitySolver solver_;
  FrozenLayers frozen_;                 // set by freeze()
  CapsuleJacobian jacobian_;            // set by linearise()
  std::shared_ptr<Evaluation> latest_;  // set by evaluate(); reset by forget(), and by set_time() and set_forces() if they change something
};

}  // namespace tanktread::coupling
