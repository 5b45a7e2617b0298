#pragma once
// Coupling of the Stokes flow to capsules, drops and rigid bodies, in unbounded flow or in a tube.

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "base/timing.hpp"
#include "base/types.hpp"
#include "system/dynamics.hpp"
#include "system/evaluation.hpp"
#include "system/interface_motion.hpp"
#include "system/particle.hpp"
#include "system/ranks.hpp"
#include "system/solids/one_body.hpp"
#include "system/solids/rigid_particles.hpp"
#include "system/solids/solid_response.hpp"
#include "system/solids/tube.hpp"
#include "system/solvers/frozen_operator.hpp"
#include "system/solvers/krylov.hpp"
#include "system/solvers/nodal_operator.hpp"
#include "system/solvers/options.hpp"
#include "system/velocity_projection.hpp"
#include "membrane/area_constraint.hpp"
#include "membrane/field.hpp"
#include "membrane/mass_solver.hpp"
#include "membrane/mass.hpp"
#include "membrane/membrane.hpp"
#include "membrane/options.hpp"
#include "membrane/symmetric_solver.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "stokes/flow/ambient_flow.hpp"
#include "stokes/layer.hpp"
#include "surface/geometry.hpp"
#include "surface/partition.hpp"
#include "surface/symmetry.hpp"

namespace tanktread::coupling {

class RigidTractions;

/// Counts of operations, as a measure of cost that does not depend on the machine.
struct Work {
  long evaluations = 0;        ///< velocity evaluations (4.2)
  long assemblies = 0;         ///< assemblies of the frozen layer operators (4.3)
  long tangents = 0;           ///< evaluations of the membrane tangent
  long solves = 0;             ///< linear solves of the implicit step
  long solver_iterations = 0;  ///< iterations of these solves
  long velocity_iterations = 0;  ///< iterations of the linear systems for velocities or tractions
  long velocity_solves = 0;      ///< solves of these systems
  long most_velocity_iterations = 0;  ///< largest number of iterations of one velocity or traction solve
};

/// Particles, medium and solver options of a Capsule.
struct CapsuleParameters {
  double viscosity = 1;                                          ///< mu of the outer fluid
  std::vector<Particle> particles{1};                            ///< particles in stacking order; the space of a single particle need not be set
  bool strong_load = false;                                      ///< true: membrane load from the pointwise equilibrium (P-3) at the
                                                                 ///< collocation sites, false: from virtual work (3.5)
  VolumeOptions volume;
  SolverOptions solvers;
  quadrature::Options quadrature;
  std::optional<stokes::PeriodicCell> cell;  ///< periodic cell at time zero, which the flow deforms, except in a duct; empty if the scene is not
                                             ///< periodic
  std::optional<stokes::PlaneWall> wall;     ///< plane wall in front of which all particles are; not set in unbounded space, a lattice or a tube
  std::optional<SolidScene> solids;          ///< plates and posts in the cell
  surface::Symmetry symmetry;  ///< common symmetry of the flow, the space and all shapes to be evaluated; without points if there is no symmetry
};

/// Computes dx/dt = v(x) for the stacked control nets x of all particles.
///
/// Basic equation, without a wall (2.4), (4.2):
///
///   B v = v_inf - (1/mu) R^{-1} A M0^{-1} dE/dx,   B = I - R^{-1} D,   b.v = 0 by P = 1 - c b^T/(b.c),  b = dV/dx, c = M0^{-1} b  (2.8)
///
/// R is the collocation matrix, M0 the mass matrix, E the energy of the membranes and V the volume of a particle. A and D are the single and the
/// double layer of all surfaces at all collocation sites. D includes the factor 1 - lambda of each surface. Each particle has its own condition
/// b.v = 0, and P is the product of the projections of all particles.
///
/// Solution: if lambda = 1, then D = 0, and the velocity needs no assembly and no linear solve. Otherwise Belos solves P B P v = P rhs, where rhs is
/// the right-hand side of the equation above. This system results from the block system of v and the Lagrange multipliers of b.v = 0 if the
/// multipliers are eliminated. P removes the mode for which B becomes singular as lambda -> 0.
///
/// Viscous membranes and interfaces: B contains the load M0^{-1} C v (3.10), where v is the fluid velocity:
///
///   B = I - R^{-1} D + (1/mu) R^{-1} A M0^{-1} C                                                                                 (3.11)
///
/// If loads are measured per current area, the mass matrix M of the current surface replaces M0.
///
/// Rigid bodies: the unknown in their rows is the double-layer density w of (2.23), see RigidParticles. Alternatively the unknown is the traction on
/// them (RigidTractions). Their motion is not stiff, so that their rows of the Jacobian are set to zero.
///
/// Symmetry: if the scene is symmetric, only the rows of fundamental control points are evaluated and solved for. All other rows are mirror images of
/// these rows.
///
/// Lattice: the layers include all images (Layer::repeat), and the frozen operators omit them. Each particle is replaced by its image in the cell
/// around the origin. The velocity of the particle is the velocity of this image, plus the difference of the ambient velocities at the two positions.
///
/// Plane wall: the layers include the images in the wall (Layer::set_wall). The frozen operator NodalOperator omits them.
///
/// Tube: the velocity caused by the wall and by the pressure drop (2.5)-(2.7) is added. It is linear in the load and, for lambda != 1, in v. Its
/// parts are added to the right-hand side and to B, both here and in the Jacobian. Alternatively v, the wall traction and the pressure drop are
/// solved for in one linear system (BlockSystem).
///
/// Plates and posts: the velocity (2.47) caused by them is added to the right-hand side and to B in the same way. The Jacobian omits it.
class Capsule : public Dynamics {
 public:
  /// `unstressed` and `initial`: control nets of shape (N, 3) on `space`. The volume of each particle of `initial` is kept, unless the particle sets
  /// `kept_volume`.
  Capsule(const spline::Space& space, const Net& unstressed, const Net& initial, const stokes::AmbientFlow& flow,
          const CapsuleParameters& parameters, Ranks& ranks, Phases& phases, std::unique_ptr<Tube> tube = nullptr);
  ~Capsule() override;

  /// Evaluates the shape x: loads, unknowns and velocities. Returns the cached result if x is the shape evaluated last and forces and flow have not
  /// changed. `guess`, if given, is the initial guess of the linear solve.
  std::shared_ptr<Evaluation> evaluate(const Net& x, const Net& guess = {});

  /// Returns an evaluation of the shape x that computes each quantity at its first use. `velocity`: velocity of the control points; no rows if
  /// unknown. A linear system is solved if a used quantity cannot be computed from the velocity, and if the shape evaluated last is farther than
  /// `distance` from x (in `norm`). If it is nearer, its rigid motions and fluid velocities are used instead.
  std::shared_ptr<Evaluation> evaluation(const Net& x, const Net& velocity, double distance);

  Net velocity(const Net& x) override { return evaluate(x)->velocity(); }
  void at(double time, double start) override;

  double next_kink(double time) const override { return flow_.next_kink(time); }
  void freeze(const Net& x) override;
  double frozen_bytes() const override;
  void linearise(const Net& x) override;
  Net solve(double shift, const Net& r, double tolerance, const Secants& secants) override;
  Net defect(const Net& x, const Net& u) override;
  bool defect_spares_system() const override { return defect_without_system(); }
  Net correction(double shift, const Net& defect, double tolerance, const Secants& secants) override;
  Net missed(const Net& change, const Net& delta, double shift) override;
  Net derivative(const Net& x, const Net& v, const Net& delta) override;
  Net mesh_motion(const Net& delta) override;
  void restore_volume(Net& x) override;
  void improve_start(Net& y, const Net& before, double shift) override;
  std::vector<Net> relabellings(const Net& x) override;
  double distance(const Net& from, const Net& to) const override;
  double norm(const Net& displacement) const override;  ///< ignores the mean displacement along x1 in a straight tube, where all x1 are equivalent
  Net symmetric(Net field) const override;

  /// Sets the virtual work of additional forces for all later calls, one row per control point; an empty net removes the forces. `contacts`: contact
  /// forces, which keep their directions and material points. `fields`: loads due to the fields on surfaces, given as minus their contribution to
  /// dE/dx (4.2).
  enum class Forces { contacts, fields };
  void set_forces(Forces of, Net work);

  /// Returns the change of the velocity at the shape of `at` due to additional forces with the virtual work `work`. Linear in `work`.
  Net response(Evaluation& at, const Net& work);

  Eigen::Index n_points() const { return space_.n_points; }

  /// Changes due to a displacement dx and to additional loads of virtual work `work`, linearised about the shape of the last linearisation. `rate`:
  /// change of the velocity of the control points; rate_change() returns it multiplied by the operator B. `slip`: change of the fluid velocity minus
  /// the velocity of the control points; empty if no control points slide.
  struct RateChange {
    Net rate, slip;
  };
  RateChange rate_change(const Net& dx, const Net& work);      ///< `rate` is B J dx (4.3) with the operator B and the Jacobian J, or J dx if control
                                                               ///< points slide. Collective
  RateChange velocity_change(const Net& dx, const Net& work);  ///< returns a RateChange whose `rate` is J dx, with the Jacobian J of the velocity.
                                                               ///< Collective
  /// Returns B v of (4.2) with frozen layer operators, or v if control points slide along an interface. Collective.
  Net left(const Net& v) { return interface_ ? v : frozen_viscous(v); }
  void prepare_step(double shift);  ///< prepares step_preconditioner
  Net step_preconditioner(const Net& r) const { return area_ ? area_->apply(r) : r; }  ///< approximate inverse of the system that `solve`
                                                                                       ///< solves

  /// Solves the linear system of an implicit step to the relative residual `tolerance`, and counts the solve. `rhs` may have any number of rows.
  /// Collective.
  Net solve_step(const Apply& product, const Apply& precondition, const Net& rhs, double tolerance);
  bool has_frozen() const { return !frozen_.empty() || !nodal_.empty(); }
  const surface::Symmetry& symmetry() const { return parameters_.symmetry; }

  /// Returns whether control points slide along an interface, so that their velocity differs from the fluid velocity.
  bool slides() const { return interface_.has_value(); }

  /// Returns whether a membrane or interface is viscous, so that the load depends on the velocity.
  bool viscous() const { return viscous_.has_value(); }

  /// Returns whether the shape evaluated last is within `distance` of x (in `norm`).
  bool evaluated_about(const Net& x, double distance) const { return latest_ && norm(x - latest_->x()) <= distance; }

  /// Returns the rigid bodies among the particles, at their positions in x.
  RigidParticles rigid_at(Net x) const {
    RigidParticles rigid = rigid_;
    rigid.place(x);
    return rigid;
  }

  const Loads& loads() const { return loads_; }

  const std::vector<Particle>& particles() const { return parameters_.particles; }
  double volume_error(double volume, std::size_t p = 0) const { return volume / volume0_[p] - 1; }  ///< V/V0 - 1 of particle p
  Tube* tube() { return tube_.get(); }      ///< null if there is no tube
  SolidResponse* solids() { return lattice_.solids.get(); }  ///< null if there are no plates or posts
  const stokes::AmbientFlow& flow() const { return flow_; }  ///< flow at the time set by `at`
  const std::optional<stokes::PeriodicCell>& cell() const { return lattice_.cell; }  ///< cell at the time set by `at`

  /// Subtracts a lattice vector from every particle so that its mean is in the cell, and returns these vectors. The cell is centred on the origin; in
  /// a channel, on the middle of the channel; and in a straight tube, whose wall moves with the particles, on the mean of the particles.
  std::vector<Vec3> put_into_cell(Net& x);

  /// Returns the ambient velocity at a point displaced by the lattice vector `shift`, minus the ambient velocity at the point itself. 0 in a duct,
  /// whose flow is periodic.
  Vec3 faster_beyond(const Vec3& shift) const { return tube_ ? Vec3::Zero() : Vec3(flow_.cell_gradient() * shift); }

  const membrane::Membrane& membrane() const { return membrane_; }
  stokes::Evaluations kernel_evaluations() const;  ///< kernel evaluations of all layers
  const VelocityProjection* projection() const { return projection_ ? &*projection_ : nullptr; }  ///< null if velocities are collocated
  const surface::Geometry& geometry() const { return geometry_; }
  const Phases& layer_phases() const { return layer_.phases(); }  ///< run time of the parts of the single layer
  stokes::Measure measure() const { return coupling::measure(particles()); }  ///< measure of the loads
  /// Returns the net whose area defines the loads (force per area): for each particle, its rows of x or of the unstressed net.
  Net measured_net(const Net& x) const { return coupling::measured_net(particles(), unstressed_, x); }
  void forget_recycled() const;  ///< discards the data of earlier solves that the preconditioner `recycled` keeps
  const Work& work() const { return work_; }
  Work& work() { return work_; }

 private:
  friend class Evaluation;

  /// Net of the particles for which the tube was set up last. `origin`: x1 of the origin of the frame of a straight periodic wall at the present
  /// time. `origin_of_net`: value of `origin` at the time when `net` was set.
  struct TubePlace {
    Net net;
    std::optional<double> origin, origin_of_net;
  };
  /// Current cell, and the plates and posts in it. Unset without a lattice.
  struct Lattice {
    std::optional<stokes::PeriodicCell> cell;
    std::unique_ptr<SolidResponse> solids;
  };
  bool repeats() const { return lattice_.cell && !tube_; }  // true if the layers are periodic; in a duct the tube's response contains the images
  bool by_sites() const { return tube_ || parameters_.solids || !flow_.affine(); }
  void place_among_solids(const Net& x);
  void put_among_solids();
  Net velocity_by_walls(const Net& x, const Net& f, const Net& v);
  void add_solids(const Net& x, const Net& f, const Net& moves, bool with_empty, Net& u);
  std::vector<Mat3> gradients_at(const Net& x) const;
  Net in_cell(Evaluation& e, const Net& guess);
  Net solve(Evaluation& e, Net x, const Net& guess);
  Net solve_tractions(Evaluation& e, const Net& x, const Net& b, const Net& c, const Net& flow);
  Mat3 moment_by_traction(Evaluation& at, std::size_t p);
  void assemble_layers(const Net& x);
  Net layers_of(const Net& x, const Net& v, const Net& f);
  bool deform_cell(double time);
  Net single_layer_of(const Net& x, const Net& f);
  Net double_layer_of(const Net& v);
  Net membrane_load(Evaluation& e, const Net& x, Net* other);
  void place(const Net& x);
  Vec3 cell_origin(const Net& x) const;
  Net explicit_velocity(const Net& x, const Net& f, const Net& moves, std::optional<Tube::Response>* answer);
  Net defect_here(const Net& x, const Net& u);
  void own(const surface::Share& share);
  void make_layers();
  void replicate(Net& net);
  void replicate_sums(Net& net);
  void gather(bool shared, Net& net);
  void gather_targets(bool shared, Net& net);
  const std::vector<int>& own_targets() const { return projection_ ? projection_->own() : own_points_; }
  Net zero_at_targets() const { return Net::Zero(projection_ ? projection_->values().rows() : space_.n_points, 3); }
  Net control_values(Net at_targets);
  Net serial_control_values(const Net& u) const { return projection_ ? projection_->control_values(u) : collocation_.solve(u); }
  void solve(const membrane::SymmetricSolver& a, std::span<Net* const> fields);
  Net solved(const membrane::SymmetricSolver& a, Net field);
  Net work_of_loads(const Net& x, std::vector<Net>& sums);
  std::vector<Net> complete_work(const Net& x, Net& work);
  void push_bodies(const Net& x);
  bool pressed() const { return forces_[0].size() > 0 || forces_[1].size() > 0; }
  Net flux_vector(const Net& x);
  void constrain(Net& v, const Net& b, const Net& c) const;
  Net energy_part(const Net& delta, const Net& work = {});
  Net without_flux(Net rate) const;
  Net inflation(const Net& c);
  Net frozen_single_layer(const Net& f);
  Net measured_load(const Net& x, Net d);
  // Returns the load due to the viscosity of membranes at the velocity v. Requires that viscous_ was updated at x.
  Net viscous_load(const Net& x, const Net& v) { return measured_load(x, viscous_work(*viscous_, v)); }
  Net viscous_work(const membrane::ViscousLoad& c, const Net& v);
  Net frozen_viscous(const Net& v);
  Net fluid_velocity_change(const Net& delta, const Net& work = {});
  stokes::Rows<double> double_rows_of(const Net& x, std::span<const int> targets);
  Net solve_velocity(const Net& x, const Net& f, const Net& b, const Net& c, const Net& rhs, const Net& guess);
  Blocks velocity_blocks() const;
  Net solve_blocks(const std::function<Net(const Net&)>& load, const std::function<Net(const Net&, const Net&)>& unbounded, const Net& f,
                   const Net& b, const Net& c, const Net& rhs);
  void note(const SolveReport& report, const Eigen::VectorXd& v);
  bool enter_tube(const Net& x);
  bool in_front_of_wall(const Net& x);
  bool flows_by_system() const;
  bool unknowns_follow() const { return !interface_ && rigid_.empty(); }  // true if the unknowns are velocities of control
                                                                                         // points
  bool defect_without_system() const;
  Net stiff_system(double shift, const Net& rhs, double tolerance, const Secants& secants);
  bool has_velocity_system() const { return double_layer_ || viscous_ || !schur(); }
  bool schur() const { return !tube_ || tractions_ || parameters_.solvers.tube == "schur"; }

  const spline::Space& space_;
  Net unstressed_, rest_;
  stokes::AmbientFlow flow_;
  CapsuleParameters parameters_;
  Ranks& ranks_;
  Phases& phases_;
  std::vector<int> own_points_;
  std::vector<int> own_elements_;  // elements that contribute to the integrals for the rank-owned points
  bool folded_ = false;            // true if own_elements_ contain one element of each symmetry orbit; fold() then adds the integrals at image points
                                   // to fundamental points
  surface::Geometry geometry_;
  membrane::MassMatrix mass_matrix_;
  membrane::Membrane membrane_;
  membrane::Tangent tangent_;
  std::optional<membrane::AreaConstraint> area_;  // set if a membrane integrates its area elasticity by a separate quadrature
  Loads loads_;  // viscous operator C (3.10), of the latest evaluation (viscous_) and of the Jacobian (linearised_viscous_); set if a membrane is
                 // viscous
  std::optional<membrane::ViscousLoad> viscous_, linearised_viscous_;  // viscous operator C (3.10) of the latest evaluation, and of the
                                                                       // Jacobian; set if a membrane is viscous
  std::optional<VelocityProjection> projection_;  // least-squares projection; not set if velocities are collocated
  stokes::Layer layer_;                           // single layer at the targets, where velocities are evaluated
  std::optional<stokes::Layer> double_layer_;     // double layer with the factors 1 - lambda, -1 for rigid bodies; not set if all factors
                                                  // vanish
  std::optional<stokes::Layer> site_layer_, site_double_layer_;  // layers at the collocation sites for the Jacobian; set if velocities are
                                                                 // evaluated at other targets
  membrane::SymmetricSolver collocation_;
  membrane::MassSolver mass_;
  Krylov velocity_solver_, step_solver_, inner_solver_;
  NodalOperator nodal_;                     // frozen single layer; the options select either nodal_ or frozen_
  FrozenOperator frozen_, frozen_double_;  // frozen layers; empty until the first call of `freeze`
  Net frozen_at_;                          // shape at which the frozen operators were assembled
  Corotation corotation_;                  // rotations of the particles from `frozen_at_` to the shape of the latest linearisation
  RigidParticles rigid_;
  std::unique_ptr<RigidTractions> tractions_;  // set if there are rigid bodies whose unknowns are their tractions
  std::optional<OneBodyInverses> alone_;  // inverses of the system (2.23) for isolated rigid bodies, used as a preconditioner; set up at the first
                                          // use
  std::optional<InterfaceMotion> interface_;  // set if any control points slide along an interface
  stokes::Rows<double> double_rows_, single_rows_;
  std::unique_ptr<Tube> tube_;
  Eigen::SparseMatrix<double> sites_;   // collocation matrix R (4.2); set if there is a tube, a solid or a wall, or if the flow is not affine;
                                        // otherwise empty
  Lattice lattice_;
  double inner_radius_ = 0;             // radius of the largest circle in the section of a straight tube about its centroid
  double latest_shift_ = 0;             // shift gamma dt of the implicit system solved last
  Net flux_, flux_response_;            // velocity gradients of the ambient flow at the collocation sites, for the shape linearised last; set if
                                        // there is a tube or a solid, or if the flow is not affine
  std::vector<Mat3> gradients_;         // velocity gradients of the ambient flow at the collocation sites, for the shape linearised last; only in a
                                        // tube or if the flow is not affine
  std::vector<double> volume0_;         // volume V0 of each particle
  Work work_;
  std::shared_ptr<Evaluation> latest_;
  std::array<Net, 2> forces_;  // virtual work of contact forces, then of loads due to fields; empty nets if there are none
  TubePlace tube_place_;
};

}  // namespace tanktread::coupling
