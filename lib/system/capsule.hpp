#pragma once
// Coupling of the Stokes flow to capsules, drops and rigid bodies: in unbounded flow, on a lattice, in front of walls or in a tube.

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "stokes/flow/ambient_flow.hpp"
#include "system/capsule_jacobian.hpp"
#include "system/capsule_parameters.hpp"
#include "system/dynamics.hpp"
#include "system/evaluation.hpp"
#include "system/interface_motion.hpp"
#include "system/parallel/layout.hpp"
#include "system/membranes.hpp"
#include "system/targets/particle_layers.hpp"
#include "system/solids/bodies/body_preconditioner.hpp"
#include "system/solids/plates/solid_response.hpp"
#include "system/solvers/frozen_layers.hpp"
#include "system/volumes.hpp"

namespace tanktread::coupling {

class RigidTractions;

/// Computes dx/dt = v(x) for the stacked control nets x of all particles.
///
/// Order of calls: set_time() sets the time. evaluate() solves for the loads and velocities of a shape and returns them as an Evaluation.
/// evaluate_on_demand() returns an Evaluation that solves only when a quantity is read that needs it. Implicit schemes call freeze() every few steps,
/// linearise() in each step, and then solve() or correction(). Schemes call restore_constraints() after a step. The functions are in capsule.cpp
/// (evaluation; solve_second_kind() lists its stages), capsule_unknowns.cpp (linear systems), capsule_cell.cpp (lattices, tubes, plates, posts) and
/// capsule_setup.cpp (construction).
///
/// Basic equation, without a wall (2.4), (4.2):
///
///   B v = v_inf - (1/mu) R^{-1} A M0^{-1} dE/dx,   B = I - R^{-1} D,   b.v = 0 by projection P = 1 - c b^T/(b.c),  b = dV/dx, c = M0^{-1} b  (2.8)
///
/// R is the collocation matrix, M0 the mass matrix, v_inf the ambient velocity, E the energy of the membranes and V the volume of a particle. A and D
/// are the single and the double layer of all surfaces at all collocation sites. D includes the factor 1 - lambda of each surface, with the viscosity
/// ratio lambda. Each particle has its own condition b.v = 0, and P is the product of the projections of all particles.
///
/// Solution: if lambda = 1, then D = 0, and the velocity needs no assembly and no linear solve. Otherwise Belos solves P B P v = P rhs, where rhs is
/// the right-hand side of the equation above. This system results from the block system of v and the Lagrange multipliers of b.v = 0 if the
/// multipliers are eliminated. P removes the mode for which B becomes singular as lambda -> 0.
///
/// Viscous membranes and interfaces: B includes the velocity caused by the load M0^{-1} C v (3.10), where v is the fluid velocity:
///
///   B = I - R^{-1} D + (1/mu) R^{-1} A M0^{-1} C                                                                                 (3.11)
///
/// If loads are measured per current area, the mass matrix M of the current surface replaces M0.
///
/// Rigid bodies: the unknown in their rows is the double-layer density w of (2.23), see RigidParticles. Alternatively the unknown is the traction on
/// them (RigidTractions).
///
/// Symmetry: if the scene is symmetric, only the rows of fundamental control points are evaluated and solved for. All other rows are mirror images of
/// these rows.
///
/// Lattice and plane wall: the layers include the periodic and mirror images of the particles (ParticleLayers). On a lattice each particle is
/// replaced by its image in the cell around the origin. The velocity of the particle is the velocity of this image, plus the difference of the
/// ambient velocities at the two positions.
///
/// Tube: the velocity caused by the wall and by the pressure drop (2.5)-(2.7) is added. This velocity is linear in the load and, for lambda != 1,
/// in v. The part due to known loads is added to the right-hand side, and the part due to v to B. Alternatively v, the wall traction and the
/// pressure drop are solved for in one linear system (TubeSystem).
///
/// Plates and posts: the velocity (2.47) that they cause is added to the right-hand side and to B in the same way.
class Capsule : public Dynamics {
 public:
  /// `unstressed` and `resting`: control nets of the unstressed and of the resting surfaces, of shape (N, 3) on `space`. The motion conserves
  /// `kept_volume` of each particle if it is set, and otherwise the volume of the particle in `resting`.
  Capsule(const spline::Space& space, const Net& unstressed, const Net& resting, const stokes::AmbientFlow& flow,
          const CapsuleParameters& parameters, Ranks& ranks, Phases& phases, std::unique_ptr<Tube> tube = nullptr);
  ~Capsule() override;

  /// Evaluates the shape x: loads, unknowns and velocities. Returns the cached result if x is the shape evaluated last and forces and flow have not
  /// changed. `guess`: initial guess of the velocity; used if the velocity is the only unknown of the linear solve. `error`: see Evaluation::solve.
  std::shared_ptr<Evaluation> evaluate(const Net& x, const Net& guess = {}, double error = 0);

  /// Returns an evaluation of the shape x that computes each quantity at its first use. `velocity`: velocity of the control points; no rows if
  /// unknown. If the shape evaluated last is within `distance` of x (in `norm`), the rigid motions and fluid velocities of that shape are used.
  /// Otherwise a linear system is solved when a quantity is needed that cannot be computed from `velocity`.
  std::shared_ptr<Evaluation> evaluate_on_demand(const Net& x, const Net& velocity, double distance);

  Net velocity(const Net& x) override { return evaluate(x)->velocity(); }
  void set_time(double time, double start) override;

  double next_kink(double time) const override { return surroundings_.flow.next_kink(time); }
  void freeze(const Net& x) override;
  bool lattice_moves() const override { return parameters_.cell && !duct_.tube && !surroundings_.solids; }
  double frozen_bytes() const override { return frozen_.bytes(); }
  void linearise(const Net& x) override;
  Net solve(double shift, const Net& r, double tolerance, const Secants& secants) override;
  Net defect(const Net& x, const Net& u) override;
  bool defect_spares_system() const override;
  Net correction(double shift, const Net& defect, double tolerance, const Secants& secants) override;
  Net jacobian_error(const Net& change, const Net& delta, double shift) override;
  Net derivative(const Net& x, const Net& v, const Net& delta) override;
  Net mesh_motion(const Net& delta) override;
  void restore_constraints(Net& x) override;
  void improve_start(Net& y, const Net& before, double shift) override;
  std::vector<Net> relabellings(const Net& x) override;
  double distance(const Net& from, const Net& to) const override;
  double norm(const Net& displacement) const override;
  Net symmetric(Net field) const override { return parameters_.symmetry.completed(std::move(field)); }

  /// Virtual work of additional forces, one row per control point; empty nets if there are none. `contacts`: contact forces, which keep their
  /// directions and material points. `fields`: loads due to the fields on surfaces, whose work is minus their contribution to dE/dx (4.2).
  struct Forces {
    Net contacts, fields;
  };
  void set_forces(Net Forces::* of, Net work);  ///< sets one kind of additional forces for all later calls

  /// Returns the change of the velocity at the shape of `at` due to additional forces with the virtual work `work`. Linear in `work`.
  Net response(Evaluation& at, const Net& work);

  Eigen::Index n_points() const { return space_.n_points; }

  CapsuleJacobian& jacobian() { return jacobian_; }
  bool has_frozen() const { return !frozen_.empty(); }
  const surface::Symmetry& symmetry() const { return parameters_.symmetry; }

  /// Returns whether control points slide along an interface, so that their velocity differs from the fluid velocity.
  bool slides() const { return interface_ != nullptr; }

  /// Returns whether a membrane or interface is viscous, so that the load depends on the velocity.
  bool viscous() const { return membranes_.viscous(); }

  /// Returns whether the shape evaluated last is within `distance` of x (in `norm`), apart from a translation along a straight tube.
  bool evaluated_about(const Net& x, double distance) const;

  /// Returns the rigid bodies among the particles, at their positions in x.
  RigidParticles rigid_at(Net x) const {
    RigidParticles rigid = bodies_.rigid;
    rigid.fit_to(x);
    return rigid;
  }

  const Membranes& membranes() const { return membranes_; }
  const membrane::Membrane& membrane() const { return membranes_.membrane(); }
  const CapsuleParameters& parameters() const { return parameters_; }
  const std::vector<Particle>& particles() const { return parameters_.particles; }
  double volume_error(double volume, std::size_t p = 0) const { return volumes_.error(volume, p); }  ///< V/V0 - 1 of particle p
  Tube* tube() { return duct_.tube.get(); }  ///< null if there is no tube
  SolidResponse* solids() { return surroundings_.solids.get(); }  ///< null if there are no plates or posts
  const stokes::AmbientFlow& flow() const { return surroundings_.flow; }  ///< flow at the time set by `set_time`
  const std::optional<stokes::PeriodicCell>& cell() const { return surroundings_.cell; }  ///< cell at the time set by `set_time`

  /// Result of move_into_cell(). `shifts`: what was subtracted for each particle; empty without a lattice. `origin`: x1 of the origin of the frame of
  /// a straight periodic wall, which moves with the particles; not set for other walls.
  struct CellMove {
    std::vector<CellShift> shifts;
    std::optional<double> origin;
  };
  /// Replaces every particle in the net x by its image whose mean control point is in the cell, and converts the velocity v of the control points, if
  /// given, to the velocity of the image. Without a lattice, does nothing. The cell is centred on the origin; in a channel, on the middle of the
  /// channel; and in a straight tube, whose wall moves with the particles, on the mean of the particles.
  CellMove move_into_cell(Net& x, Net* v = nullptr) const;
  /// Moves x and v into the cell, as move_into_cell(), and sets the tube, if there is one, to the shape x in the cell.
  void place(Net& x, Net* v = nullptr);

  stokes::Evaluations kernel_evaluations() const;  ///< kernel evaluations of all layers
  const Targets& targets() const { return targets_; }
  const VelocityProjection* projection() const { return targets_.projection(); }  ///< null if velocities are collocated
  const surface::Geometry& geometry() const { return volumes_.geometry(); }
  const Phases& layer_phases() const { return layers_.single_layer().phases(); }  ///< run time of the parts of the single layer
  stokes::Measure measure() const { return membranes_.measure(); }  ///< area (unstressed or current) to which the loads refer
  void forget_recycled() const;  ///< discards the data of earlier solves that the preconditioner `recycled` keeps
  const OperationCounts& counts() const { return counts_; }
  OperationCounts& counts() { return counts_; }

 private:
  friend class Evaluation;

  /// Ambient flow, cell, plates and posts at the time set by `set_time`. `cell` and `solids` are unset without a lattice.
  struct Surroundings {
    stokes::AmbientFlow flow;
    std::optional<stokes::PeriodicCell> cell;
    std::unique_ptr<SolidResponse> solids;
  };
  /// Tube or channel. `net`, `origin`: arguments of the latest call of set_tube_shape().
  struct Duct {
    std::unique_ptr<Tube> tube;
    Net net;
    std::optional<double> origin;
  };
  /// Rigid bodies among the particles. `tractions`: set if the unknowns on the bodies are their tractions. `isolated`: inverses of the system (2.23)
  /// for isolated bodies, used as a preconditioner; set up at the first use.
  struct Bodies {
    RigidParticles rigid;
    std::unique_ptr<RigidTractions> tractions;
    std::optional<OneBodyInverses> isolated;
  };
  /// Returns whether the ambient velocity is evaluated at the targets. Otherwise it is affine, and exact at the control points.
  bool flow_at_targets() const { return duct_.tube || parameters_.solids || !surroundings_.flow.affine(); }
  /// Returns whether the wall traction is eliminated from the velocity system, so that only the particles have unknowns in the system.
  bool eliminates_walls() const { return !duct_.tube || bodies_.tractions || parameters_.solvers.eliminates_walls(); }
  bool has_velocity_system() const { return jacobian_.has_system() || !eliminates_walls(); }
  bool unknowns_are_velocities() const { return !interface_ && bodies_.rigid.empty(); }  // true if all unknowns are velocities of control points
  bool has_forces() const { return forces_.contacts.size() > 0 || forces_.fields.size() > 0; }
  // In the functions below, x is a shape whose particles are in the cell (place), if there is a lattice, and `shape` is any shape.
  // Evaluation of a shape (capsule.cpp).
  SolvedShape solve_shape(const Net& shape, const Net& guess, double error);
  Net solve_in_cell(const Net& x, const Net& guess, SolvedShape& found);
  Net solve_second_kind(const Net& x, const Net& guess, VolumeConstraint& volume, SolvedShape& found);
  Net solve_first_kind(const Net& x, VolumeConstraint& volume, SolvedShape& found);
  bool in_fluid(const Net& x) const;
  void push_bodies(const Net& x);
  WorkOfLoads work_of_loads(const Net& x);
  Net membrane_load(const Net& x, WorkOfLoads& known, VolumeConstraint* volume = nullptr);
  Net explicit_velocity(const Net& x, const Net& f, const Net& particle_velocity, std::optional<Tube::Response>* answer);
  // Cells of lattices, tubes, plates and posts (capsule_cell.cpp).
  bool deform_cell(double time);
  Vec3 cell_origin(const Net& x) const;
  void set_tube_shape(const Net& x, std::optional<double> origin);
  void set_solid_shape(const Net& x);
  Tube::Response add_walls(const Net& x, const Net& f, const Net& v, bool with_empty, Net& u);
  // Linear systems (capsule_unknowns.cpp).
  Net velocity_load(const Net& x, const Net& v);
  Net velocity_product(const Net& x, const Net& v, const Net& load);
  Apply velocity_preconditioner(const Net& x);
  Net solve_velocity(const Net& x, const Net& f, const VolumeConstraint& volume, const Net& rhs, const Net& guess, double error);
  Net solve_blocks(const Net& x, const Net& f, const VolumeConstraint& volume, const Net& rhs);
  Net deformable_velocity(const VolumeConstraint& volume, const Net& y) const;
  Net traction_load(const Net& x, const Net& y, const Net& v);
  Net traction_product(const Net& x, const VolumeConstraint& volume, const Net& y, const Net& caused);
  Net solve_tractions(const Net& x, const VolumeConstraint& volume, const Net& flow, SolvedShape& found);
  Mat3 moment_by_traction(const Net& x, const SolvedShape& at, std::size_t p);
  void record_solve(const SolveReport& report, bool finite, double tolerance);

  // Order of initialisation: a member may use those before it. The constructor's body sets up plates and posts, the tube, tractions and the cell.
  // Members that depend on the latest shape, and what sets them:
  //   latest_                 evaluate(); reset by set_time() and set_forces() if they change something
  //   duct_                   place() and solve_shape(), by set_tube_shape()
  //   surroundings_.solids    add_walls() and Evaluation::solid_flow(), by set_solid_shape()
  //   bodies_.rigid           solve_shape() and restore_constraints()
  //   bodies_.tractions       solve_tractions()
  //   layers_                 each call with its shape; rows that are stored, by assemble() in solve_velocity() and solve_tractions()
  //   frozen_                 freeze()
  //   jacobian_               linearise()
  const spline::Space& space_;
  Net resting_;
  Surroundings surroundings_;
  CapsuleParameters parameters_;
  Phases& phases_;
  OperationCounts counts_;
  Layout layout_;
  Targets targets_;
  Membranes membranes_;
  Volumes volumes_;
  ParticleLayers layers_;
  FrozenLayers frozen_;
  Duct duct_;
  Bodies bodies_;
  std::unique_ptr<InterfaceMotion> interface_;  // set if any control points slide along an interface
  Krylov velocity_solver_;
  CapsuleJacobian jacobian_;
  std::shared_ptr<Evaluation> latest_;
  Forces forces_;
};

}  // namespace tanktread::coupling
