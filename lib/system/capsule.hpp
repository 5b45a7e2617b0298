#pragma once
// Capsules, drops and rigid bodies, in unbounded flow or in a tube: fluid and membrane meet here.

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
#include "system/solids/rigid_tractions.hpp"
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

/// Work in units that do not depend on the machine.
struct Work {
  long evaluations = 0;        ///< velocity evaluations (4.2)
  long assemblies = 0;         ///< of the frozen layer operator (4.3)
  long tangents = 0;           ///< of the membrane
  long solves = 0;             ///< linear solves of the implicit step
  long solver_iterations = 0;  ///< of all of them
  long velocity_iterations = 0;  ///< of the systems that velocities come from when the viscosities differ, or blocks are asked for in a tube
  long velocity_solves = 0;      ///< of these systems
  long most_velocity_iterations = 0;  ///< of one of them
};

/// What particles are made of and how they are solved.
struct CapsuleParameters {
  double viscosity = 1;                                          ///< mu of the outer fluid
  std::vector<Particle> particles{1};                            ///< stacked in this order; one alone need not name its space
  bool strong_load = false;                                      ///< (P-3) at the collocation sites instead of (3.5)
  VolumeOptions volume;
  SolverOptions solvers;
  quadrature::Options quadrature;
  std::optional<stokes::PeriodicCell> cell;  ///< at time zero, of a lattice that the flow carries along; none: unbounded space, or a tube
  std::optional<stokes::PlaneWall> wall;     ///< that everything is in front of; none: unbounded space, a lattice or a tube
  surface::Symmetry symmetry;  ///< of flow, space and every shape that is asked about; of no points: none
};

/// dx/dt = v(x) of the stacked nets of all particles without a wall (2.4), (4.2):
///
///   B v = v_inf - (1/mu) R^{-1} A M0^{-1} dE/dx,   B = I - R^{-1} D,   b.v = 0 by P = 1 - c b^T/(b.c),  b = dV/dx, c = M0^{-1} b  (2.8)
///
/// A, D: the single and the double layer of all surfaces at the sites of all; D with the factor 1 - lambda of each. One condition b.v = 0, and one
/// factor of P, a particle.
/// For lambda = 1 nothing has to be assembled or solved for the velocity. Otherwise P B P v = P (...) is solved by Belos; that is the block
/// system of v and the multiplier of (2.8) with the multiplier eliminated, and it keeps the mode that B nearly loses as lambda -> 0 out of reach.
///
/// The load M0^{-1} C v (3.10) of a viscous membrane or interface, v the fluids' velocity, is part of B: with M of the current surface in place of
/// M0 if loads are measured there, B = I - R^{-1} D + (1/mu) R^{-1} A M0^{-1} C                                                        (3.11)
///
/// Rigid bodies among them move rigidly (RigidParticles): in their rows the unknown is w of (2.23), and in Jacobian and stiff steps they only follow.
/// Where all are rigid, their tractions may be solved for instead (RigidTractions).
///
/// Of a symmetric scene only the rows of fundamental control points are evaluated, and only their systems solved; the others are their images.
///
/// On a lattice the layers are those of all images (Layer::repeat). Every particle is evaluated where its mean is in the cell around the origin, and
/// moves on where it is, with what the flow is faster there. Frozen operators leave images out.
///
/// Beside a plane wall the layers are those of their images too (Layer::set_wall); the frozen operator by one node a control point leaves
/// images out.
///
/// In a tube the answer of wall and pressure drop (2.5)-(2.7) is added, which is linear in the load and, for lambda != 1, in v: it joins the
/// right-hand side and B, here and in the Jacobian. Or all blocks are solved at once (BlockSystem).
class Capsule : public Dynamics {
 public:
  /// `unstressed` and `initial`: control nets of shape (N, 3) on `space`; the volume of `initial` is kept where parameters give no other.
  Capsule(const spline::Space& space, const Net& unstressed, const Net& initial, const stokes::AmbientFlow& flow,
          const CapsuleParameters& parameters, Ranks& ranks, Phases& phases, std::unique_ptr<Tube> tube = nullptr);
  ~Capsule() override;

  /// Everything that the shape x determines. A system starts from `guess`, where there is one. Of the shape that was asked about last, under the same
  /// forces and flow, it is what was returned then.
  std::shared_ptr<Evaluation> evaluate(const Net& x, const Net& guess = {});

  /// The same of a shape whose velocity is known, or not (no rows). It solves for the unknowns only where they are asked for and do not follow from
  /// velocity. Those of the shape asked about last stand for them if it is within `distance` (in `norm`).
  std::shared_ptr<Evaluation> evaluation(const Net& x, const Net& velocity, double distance);

  Net velocity(const Net& x) override { return evaluate(x)->velocity(); }
  void at(double time, double start) override;

  double next_kink(double time) const override { return flow_.next_kink(time); }
  void freeze(const Net& x) override;
  double frozen_bytes() const override;
  void linearise(const Net& x) override;
  Net solve(double shift, const Net& r, double tolerance, const Secants& secants) override;
  Net missed(const Net& dv, const Net& delta) override;
  Net defect(const Net& x, const Net& u) override;
  bool defect_spares_system() const override { return defect_without_system(); }
  Net correction(double shift, const Net& defect, double tolerance, const Secants& secants) override;
  Net missed_of(const Net& change, const Net& delta, double shift) override;
  Net derivative(const Net& x, const Net& v, const Net& delta) override;
  Net mesh_motion(const Net& delta) override;
  void restore_volume(Net& x) override;
  void improve_start(Net& y, const Net& before, double shift) override;
  std::vector<Net> relabellings(const Net& x) override;
  double distance(const Net& from, const Net& to) const override;
  double norm(const Net& displacement) const override;  ///< in a tube without the mean along it, on which nothing depends
  Net symmetric(Net field) const override;

  /// Sets the virtual work of forces, one row per control point, from now on: of contacts, which keep directions and points, or of the fields on
  /// surfaces, minus what they add to dE/dx. An empty net: none.
  enum class Forces { contacts, fields };
  void set_forces(Forces of, Net work);

  /// The change of the velocity at the shape of `at` by forces of this virtual work in addition to those that act: linear in `work`.
  Net response(Evaluation& at, const Net& work);

  Eigen::Index n_points() const { return space_.n_points; }

  /// Changes that a displacement dx, and a change of the load's virtual work in addition to that of the membranes, make where last linearised. slip:
  /// velocity of the fluids minus that of the control points; empty if none slides.
  struct RateChange {
    Net rate, slip;
  };
  RateChange rate_change(const Net& dx, const Net& work);      ///< rate: B J dx if no point slides, otherwise J dx. Collective
  RateChange velocity_change(const Net& dx, const Net& work);  ///< rate: J dx. Collective
  /// B v with B frozen, or v if control points slide. Collective.
  Net left(const Net& v) { return interface_ ? v : frozen_viscous(v); }
  void prepare_step(double shift);  ///< prepares step_preconditioner
  bool preconditions_step() const { return area_.has_value(); }
  Net step_preconditioner(const Net& r) const { return area_ ? area_->apply(r) : r; }  ///< approximate inverse of the system of `solve`

  /// Solves the linear system of an implicit step for `rhs`, a state of any number of rows, to this relative residual, and counts it. Collective.
  Net solve_step(const Apply& product, const Apply& precondition, const Net& rhs, double tolerance);
  bool has_frozen() const { return !frozen_.empty() || !nodal_.empty(); }
  const surface::Symmetry& symmetry() const { return parameters_.symmetry; }

  /// Whether control points slide along the interface, so that their velocity is not the fluids'.
  bool slides() const { return interface_.has_value(); }

  /// Returns whether a membrane or interface is viscous, so that the load depends on the velocity.
  bool viscous() const { return viscous_.has_value(); }

  /// Whether the latest place that was asked about is within `distance` (in `norm`) of x.
  bool evaluated_about(const Net& x, double distance) const { return latest_ && norm(x - latest_->x()) <= distance; }

  /// The rigid bodies among the particles, placed as x says.
  RigidParticles rigid_at(Net x) const {
    RigidParticles rigid = rigid_;
    rigid.place(x);
    return rigid;
  }

  const Loads& loads() const { return loads_; }

  const std::vector<Particle>& particles() const { return parameters_.particles; }
  double volume_error(const Net& x) const;  ///< of all volumes together
  double volume_error(double volume, std::size_t p = 0) const { return volume / volume0_[p] - 1; }  ///< V/V0 - 1 of particle p
  Tube* tube() { return tube_.get(); }      ///< nothing without one
  const stokes::AmbientFlow& flow() const { return flow_; }  ///< at the time told last
  const std::optional<stokes::PeriodicCell>& cell() const { return cell_; }  ///< at the time told last

  /// Moves every particle into the cell by a lattice vector, and returns these vectors. The cell is around the origin, or in a straight tube, whose
  /// wall moves along, around the mean of the particles.
  std::vector<Vec3> put_into_cell(Net& x);

  /// How much faster the flow is a lattice vector further; a duct's flow repeats.
  Vec3 faster_beyond(const Vec3& shift) const { return tube_ ? Vec3::Zero() : Vec3(flow_.gradient(Vec3::Zero()) * shift); }

  const membrane::Membrane& membrane() const { return membrane_; }
  stokes::Evaluations kernel_evaluations() const;  ///< of both layers
  const VelocityProjection* projection() const { return projection_ ? &*projection_ : nullptr; }  ///< none: velocities are collocated
  const surface::Geometry& geometry() const { return geometry_; }
  const Phases& layer_phases() const { return layer_.phases(); }  ///< where the time of the single layer goes
  stokes::Measure measure() const { return coupling::measure(particles()); }  ///< of the load
  Net measured_net(const Net& x) const { return coupling::measured_net(particles(), unstressed_, x); }  ///< of the load
  void forget_recycled() const;  ///< discards what preconditioners `recycled` keep from earlier solves
  const Work& work() const { return work_; }
  Work& work() { return work_; }

 private:
  friend class Evaluation;

  /// Particles placed in the tube, and the origin along x1 of the frame of a straight wall that repeats, now and when they were placed.
  struct TubePlace {
    Net net;
    std::optional<double> origin, origin_of_net;
  };
  bool repeats() const { return cell_ && !tube_; }  // the layers do; in a duct the tube's response has the images
  bool by_sites() const { return tube_ || !flow_.affine(); }
  Net ambient(const Net& x) const;
  std::vector<Mat3> gradients_at(const Net& x) const;
  Net in_cell(Evaluation& e, const Net& guess);
  Net solve(Evaluation& e, Net x, const Net& guess);
  Net solve_tractions(Evaluation& e, const Net& x);
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
  Net viscous_load(const Net& x, const Net& v) { return measured_load(x, viscous_work(*viscous_, v)); }  // where C was updated
  Net viscous_work(const membrane::ViscousLoad& c, const Net& v);
  Net frozen_viscous(const Net& v);
  Net fluid_velocity_change(const Net& delta, const Net& work = {});
  stokes::Rows<double> double_rows_of(const Net& x, std::span<const int> targets, bool assembled);
  Net solve_velocity(const Net& x, const Net& f, const Net& b, const Net& c, const Net& rhs, const Net& guess);
  Blocks velocity_blocks() const;
  Net solve_blocks(const std::function<Net(const Net&)>& unbounded, const Net& f, const Net& b, const Net& c, const Net& rhs);
  void note(const SolveReport& report, const Eigen::VectorXd& v);
  void note_tractions(const Net& v);
  bool enter_tube(const Net& x);
  bool in_front_of_wall(const Net& x);
  bool by_tractions() const { return parameters_.solvers.rigid_bodies == "first kind"; }
  bool flows_by_system() const;
  bool unknowns_follow() const { return !interface_ && !tractions_ && rigid_.empty(); }  // from the velocity of the control points
  bool defect_without_system() const;
  Net stiff_system(double shift, const Net& rhs, double tolerance, const Secants& secants);
  bool has_velocity_system() const { return double_layer_ || viscous_ || !schur(); }
  bool schur() const { return !tube_ || parameters_.solvers.tube == "schur"; }

  const spline::Space& space_;
  Net unstressed_, rest_;
  stokes::AmbientFlow flow_;
  CapsuleParameters parameters_;
  Ranks& ranks_;
  Phases& phases_;
  std::vector<int> own_points_;
  std::vector<int> own_elements_;  // that sums for own points run over
  bool folded_ = false;            // those are fundamental ones, and their sums are to be folded
  surface::Geometry geometry_;
  membrane::MassMatrix mass_matrix_;
  membrane::Membrane membrane_;
  membrane::Tangent tangent_;
  std::optional<membrane::AreaConstraint> area_;  // where a membrane has points of its own for its area
  Loads loads_;  // in addition to elasticity and bending
  std::optional<membrane::ViscousLoad> viscous_, linearised_viscous_;  // where a membrane is: of the latest evaluation, of the Jacobian
  std::optional<VelocityProjection> projection_;  // where velocities are not collocated
  stokes::Layer layer_;                           // at the targets of velocities
  std::optional<stokes::Layer> double_layer_;     // where a lambda is not 1; of the factors 1 - lambda
  std::optional<stokes::Layer> site_layer_, site_double_layer_;  // at the collocation sites, for the Jacobian, where targets are others
  membrane::SymmetricSolver collocation_;
  membrane::MassSolver mass_;
  Krylov velocity_solver_, step_solver_, inner_solver_;
  NodalOperator nodal_;                     // or frozen_, as the options say
  FrozenOperator frozen_, frozen_double_;  // empty until the first freeze
  Net frozen_at_;                          // shape at which they were assembled
  Corotation corotation_;                  // from there to the shape linearised last
  RigidParticles rigid_;
  std::optional<RigidTractions> tractions_;  // where rigid bodies, alone, are solved for by these
  std::optional<OneBodyInverses> alone_;  // made when first needed
  std::optional<InterfaceMotion> interface_;  // not for material motion
  stokes::Rows<double> double_rows_, single_rows_;
  std::unique_ptr<Tube> tube_;
  Eigen::SparseMatrix<double> sites_;   // R, where the flow is not affine or there is a tube or a wall
  std::optional<stokes::PeriodicCell> cell_;  // now
  double inner_radius_ = 0;             // of a circle inside of the tube, about its centroid
  double latest_shift_ = 0;             // of the implicit system solved last
  Net flux_, flux_response_;            // b and c of the Jacobian's P, empty where it has none
  std::vector<Mat3> gradients_;         // of a flow that is not affine, or in a tube, at the sites, as linearised
  std::vector<double> volume0_;         // of each particle
  Work work_;
  std::shared_ptr<Evaluation> latest_;
  std::array<Net, 2> forces_;  // their work, of contacts and of fields on what deforms; empty nets: none
  TubePlace tube_place_;
};

}  // namespace tanktread::coupling
