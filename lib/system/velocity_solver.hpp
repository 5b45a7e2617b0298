#pragma once
// Loads, unknowns and velocities of capsules, drops and rigid bodies at one shape: in unbounded flow, on a lattice, in front of walls or in a tube.

#include <algorithm>
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "stokes/flow/ambient_flow.hpp"
#include "system/capsule_parameters.hpp"
#include "system/equations/user_equation.hpp"
#include "system/membranes.hpp"
#include "system/parallel/row_share.hpp"
#include "system/solids/bodies/rigid_particles.hpp"
#include "system/solids/fluid_walls.hpp"
#include "system/solved_shape.hpp"
#include "system/targets/particle_layers.hpp"
#include "system/volumes.hpp"

namespace tanktread::coupling {

class OneBodyInverses;
class RigidTractions;

/// Solves for the velocity v(x) of all particles at a shape x, the stacked control nets. solve() is the entry point. The
/// functions are in velocity_solver.cpp; at_shape(), which lists the equations of a scene, and the solves are in velocity_solver_systems.cpp.
///
/// Basic equation, without a wall (2.4), (4.2):
///
///   B v = v_inf - (1/mu) R^{-1} A M0^{-1} dE/dx,   B = I - R^{-1} D,   b.v = 0 by projection P = 1 - c b^T/(b.c),  b = dV/dx, c = M0^{-1} b  (2.8)
///
/// R is the collocation matrix, M0 the mass matrix, v_inf the ambient velocity, E the energy of the membranes and V the volume of a particle. A and D
/// are the single and the double layer of all surfaces at all collocation sites. D includes the factor 1 - lambda of each surface, with the viscosity
/// ratio lambda. Each particle has its own condition b.v = 0, and P is the product of the projections of all particles. This requires that c is zero
/// on all other particles, which holds for the volumes (VolumeProjection).
///
/// Solution: if lambda = 1, then D = 0, and the velocity needs no assembly and no linear solve. Otherwise Belos solves P B P v = P rhs, where rhs is
/// the right-hand side of the equation above. P removes the mode for which B becomes singular as lambda -> 0. Further unknowns
/// may be the multipliers of b.v = 0, the wall traction and the pressure drop of a tube. System contains all of them.
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
/// in v. The part due to known loads is added to the right-hand side, and the part due to v to B. Alternatively the wall traction and the pressure
/// drop are unknowns.
///
/// Plates and posts: the velocity (2.47) that they cause is added to the right-hand side and to B in the same way.
///
/// Nets are replicated on all ranks. Calls with a shape are collective.
class VelocitySolver {
 public:
  /// The arguments are explained at the constructor of Capsule.
  VelocitySolver(const spline::Space& space, const Net& unstressed, const Net& resting, const stokes::AmbientFlow& flow,
                 const CapsuleParameters& parameters, Phases& phases, std::unique_ptr<Tube> tube);
  ~VelocitySolver();

  /// Sets the time of the flow and of the cell (see Dynamics::set_time). Returns whether one of them has changed.
  bool set_time(double time, double start);

  /// Virtual work of additional forces, one row per control point; empty nets if there are none. `contacts`: contact forces, which keep their
  /// directions and material points. `fields`: loads due to the fields on surfaces, whose work is minus their contribution to dE/dx (4.2).
  struct Forces {
    Net contacts, fields;

    // returns all kinds of forces; a kind that acts on rigid bodies must also be added in push_bodies()
    std::array<const Net*, 2> all() const { return {&contacts, &fields}; }
  };
  static_assert(sizeof(Forces) == 2 * sizeof(Net), "Forces::all() must return each kind of forces");
  bool set_forces(Net Forces::* of, Net work);  ///< sets one kind of additional forces for all later calls. Returns whether it has changed
  const Forces& forces() const { return forces_; }
  bool has_forces() const {
    return std::ranges::any_of(forces_.all(), [](const Net* work) { return work->size() > 0; });
  }

  /// Solves (4.2) at a shape. `guess`: initial guess of the velocity for the linear solve; not used if there are rigid bodies. `error`: see
  /// SolvedShape.
  SolvedShape solve(const Net& shape, const Net& guess, double error);

  /// Sets an approximate inverse of the operator B of (4.2). Later calls of solve() that allow an error (`error` > 0) use it if there are no rigid
  /// bodies. They need only a few products with B, so that no rows are assembled for them. Exact solves do not use the inverse, because it belongs to
  /// the latest implicit step, which a resumed run does not know.
  void use_inverse(std::function<Net(const Net&)> inverse) { solving_.inverse = std::move(inverse); }

  /// Returns the defect P (w - B P u) - (1 - P) u of a velocity u (3.14), where B v = w is the linear system for the velocity v at the shape, and P
  /// the volume projection (2.8). Needs no linear solve. Requires that all unknowns are velocities and that walls are eliminated.
  Net defect(const Net& shape, const Net& u);

  /// Returns the virtual work of the loads and of the additional forces.
  WorkOfLoads work_of_loads(const Net& x);

  /// Returns the load of the membranes at x. `known`: virtual work of the loads at x, computed here if it has no rows. On a lattice, particles may be
  /// moved into the cell, which changes no load.
  Net membrane_load(const Net& x, WorkOfLoads& known) { return load_and_projection(x, known, nullptr); }

  /// Returns the first moment int df_i r_j dGamma of the load df on particle p, a rigid body whose unknown is its traction, at the shape that was
  /// solved last. r is the position relative to the centre of the body.
  Mat3 moment_by_traction(std::size_t p);

  /// Returns the blocks of unknowns of the system at a shape, its equations, and whether they are solved by iteration; for the plan. Collective.
  std::string plan(const Net& shape);

  bool slides() const { return interface_ != nullptr; }        ///< whether control points slide along an interface
  bool viscous() const { return membranes_.viscous(); }        ///< whether a membrane or interface is viscous: then the load depends on the velocity
  bool is_explicit() const { return !layers_.has_double() && !viscous(); }  ///< whether B of (4.2) is the identity

  /// Returns whether the load on particles depends on the unknowns of the system, so that it is known only after a solve at the same shape. With the
  /// velocity of an implicit step, the load of a viscous membrane has an up to 20 times larger error.
  bool load_depends_on_unknowns() const { return viscous() || !bodies_.rigid.empty() || !solving_.added.empty(); }

  /// Returns whether all unknowns are velocities of control points: no control point slides along an interface, no particle is a rigid body, and no
  /// equations are added.
  bool unknowns_are_velocities() const { return !interface_ && bodies_.rigid.empty() && solving_.added.empty(); }

  /// Returns whether the wall traction is eliminated from the velocity system, so that only the particles have unknowns in the system.
  bool eliminates_walls() const { return !tube_ || bodies_.tractions || parameters_.solvers.eliminates_walls(); }

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
  /// Moves x and v into the cell, as move_into_cell() does, and sets the walls to the shape x in the cell, which it returns.
  Net place(Net x, Net* v = nullptr);

  /// Returns the rigid bodies. Their motions belong to the shape solved last. Their positions were set by the latest call of solve() or
  /// Capsule::restore_constraints().
  RigidParticles& rigid() { return bodies_.rigid; }
  const RigidParticles& rigid() const { return bodies_.rigid; }
  const CapsuleParameters& parameters() const { return parameters_; }
  const std::vector<Particle>& particles() const { return parameters_.particles; }
  const stokes::AmbientFlow& flow() const { return flow_; }                  ///< flow at the time set by `set_time`
  const std::optional<stokes::PeriodicCell>& cell() const { return cell_; }  ///< cell at the time set by `set_time`; not set without a lattice
  const FluidWalls& walls() const { return walls_; }
  /// Returns which particle crosses which wall or post in the latest shape; empty if all are in the fluid.
  const std::string& crossing() const { return crossing_; }
  const RowShare& layout() const { return layout_; }
  const Targets& targets() const { return targets_; }
  Membranes& membranes() { return membranes_; }
  const Membranes& membranes() const { return membranes_; }
  const UserEquations& equations() const { return solving_.added; }  ///< equations that the program adds
  Volumes& volumes() { return volumes_; }
  const Volumes& volumes() const { return volumes_; }
  ParticleLayers& layers() { return layers_; }
  InterfaceMotion* interface() { return interface_.get(); }  ///< null if no control points slide

  stokes::Evaluations kernel_evaluations() const;  ///< number for all layers at the targets, the walls and the tractions on bodies
  OperationCounts& counts() { return counts_; }
  const OperationCounts& counts() const { return counts_; }

 private:
  /// Rigid bodies among the particles. `tractions`: set if the unknowns on the bodies are their tractions. `isolated`: inverses of the system (2.23)
  /// for isolated bodies, used as a preconditioner; set up at the first use.
  struct Bodies {
    RigidParticles rigid;
    std::unique_ptr<RigidTractions> tractions;
    std::unique_ptr<OneBodyInverses> isolated;
  };
  bool keeps_multipliers() const {
    return parameters_.volume.constrained() && !bodies_.tractions && parameters_.solvers.keeps_multipliers(!eliminates_walls());
  }
  Net symmetric(Net field) const { return parameters_.symmetry.completed(std::move(field)); }
  bool bodies_respond() const { return layers_.repeats() || walls_.any() || !is_explicit(); }  // see RigidTractions::Surroundings::responds
  bool has_velocity_system() const { return !is_explicit() || !eliminates_walls() || keeps_multipliers() || !solving_.added.empty(); }
  // In the functions below, x is a shape whose particles are in the cell (place), if there is a lattice.
  /// How linear systems are solved. `unknowns`: see unknowns(), set at its first call. `inverse`: see use_inverse(). `added`: see equations().
  struct Solving {
    Krylov krylov;
    std::array<std::shared_ptr<const Layout>, 2> unknowns;
    std::function<Net(const Net&)> inverse;
    UserEquations added;
  };
  /// The system at the shape x, with what it refers to.
  struct AtShape {
    Net x;
    VolumeProjection volume;  // projection (2.8) at x; not active if the volumes are free
    std::vector<const Equation*> added{};  // equations of the program
    std::optional<System> system;
  };
  // Stages.
  Net solve_in_cell(const Net& x, std::span<const CellShift> shifts, const Net& guess, SolvedShape& found);
  Net solve_second_kind(AtShape& at, const Net& guess, SolvedShape& found);
  Net load_and_projection(const Net& x, WorkOfLoads& known, VolumeProjection* volume);
  bool in_fluid(const Net& x);
  void push_bodies(const Net& x, const Net& work = {});
  // Cells of lattices, tubes, plates and posts.
  bool deform_cell(double time);
  Vec3 cell_origin(const Net& x) const;
  // The system and its solution (velocity_solver_systems.cpp).
  std::shared_ptr<const Layout> unknowns(bool multipliers);
  std::shared_ptr<AtShape> at_shape(const Net& x, WorkOfLoads& known, bool multipliers, std::span<const CellShift> shifts = {});
  void set_load(const AtShape& at, const BlockVector& y, SolvedShape& found);
  bool uses_inverse(double error, double tolerance) const;
  Apply velocity_preconditioner(const Net& x);
  BlockVector solve_velocity(AtShape& at, const BlockVector& right, const Net& guess, double error);
  Net solve_tractions(const std::shared_ptr<AtShape>& at, SolvedShape& found);
  void record_solve(const SolveReport& report, bool finite, double tolerance);

  // Order of initialisation: the initialiser of a member may use the members declared before it. The constructor's body sets up tractions and the
  // cell. Members that depend on the latest shape, and the functions that set them:
  //   cell_               set_time()
  //   walls_              place() and solve()
  //   membranes_          viscous loads: each call with its shape; changes of work: CapsuleJacobian::linearise()
  //   interface_          velocities: each call with its shape; derivative: CapsuleJacobian::linearise()
  //   bodies_.rigid       solve() and Capsule::restore_constraints()
  //   bodies_.tractions   solve_tractions()
  //   solving_.inverse    Capsule::linearise()
  //   layers_             each call with its shape; rows that are stored, by assemble() in solve_velocity() and solve_tractions()
  const spline::Space& space_;
  Net resting_;
  stokes::AmbientFlow flow_;
  std::optional<stokes::PeriodicCell> cell_;
  CapsuleParameters parameters_;
  Phases& phases_;
  OperationCounts counts_;
  RowShare layout_;
  Targets targets_;
  Membranes membranes_;
  Volumes volumes_;
  ParticleLayers layers_;
  std::unique_ptr<Tube> tube_;             // tube or channel
  std::unique_ptr<SolidResponse> solids_;  // plates and posts
  FluidWalls walls_;                       // refers to tube_ and solids_
  std::string crossing_;                   // see crossing(); set by in_fluid()
  Solving solving_;  // before bodies_, whose systems refer to the added equations
  Bodies bodies_;
  std::unique_ptr<InterfaceMotion> interface_;  // set if any control points slide along an interface
  Forces forces_;
};

}  // namespace tanktread::coupling
