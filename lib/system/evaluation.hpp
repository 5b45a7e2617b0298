#pragma once
// Loads, unknowns and velocities at one shape.

#include <memory>
#include <vector>

#include "base/types.hpp"
#include "system/velocity_solver.hpp"

namespace tanktread::coupling {

class Capsule;

/// Loads, unknowns and velocities of a shape under the forces that act on it (4.2). The Evaluation returned by Capsule::evaluate contains all of
/// them. An Evaluation constructed from a shape and its velocity computes the other quantities at first use, with the time and the forces that the
/// Capsule then has, and caches them. It solves the linear system for the unknowns only if they do not follow from the velocity. Nets have one row
/// per control point of all particles. The Capsule must outlive this object. References that functions return are valid until a call that solves the
/// system. Calls are collective.
class Evaluation {
 public:
  /// `velocity`: velocity of the control points if it is already known, for example from the equations of an implicit step; no rows if unknown.
  /// `near`: evaluation at nearly the same shape, or null. Until the linear system is solved at x, the motions of rigid bodies and, if control points
  /// slide along interfaces, the fluid velocity are taken from `near`.
  Evaluation(Capsule& system, Net x, Net velocity = {}, std::shared_ptr<Evaluation> near = nullptr);
  Evaluation(Capsule& system, Net x, SolvedShape solution);  ///< evaluation of a shape whose system is solved already

  const Net& x() const { return x_; }                    ///< shape, (N, 3)
  const Net& velocity();                                 ///< velocity of the control points, length/time
  const Net& fluid_velocity();                           ///< velocity of the fluids on the surface; equals `velocity` unless control points slide
  const Net& virtual_work() { return work_of_loads().work; }  ///< WorkOfLoads::work
  const std::vector<Net>& load_sums();                   ///< WorkOfLoads::sums; empty, without computing the work, if no load has any
  const Slip& slip() const { return known_.slip; }       ///< slip along the meshes of interfaces; empty if the system is not solved at x

  /// Returns the control values of the load of the fluids on the membranes, per unstressed or per current area, depending on the particle. For a
  /// rigid body whose unknown is a density w, this is the load df of (2.23): a field of the form of a rigid motion whose resultants are minus the
  /// force and torque of the body on the fluid. For a body whose unknown is the traction, it is the traction on the body.
  const Net& load();

  const BlockVector& solution();                         ///< unknowns of all equations, if the program adds equations; otherwise absent
  const RigidParticles& rigid();                         ///< returns the rigid bodies with their motion at this shape
  const Tube::Response& response();                      ///< returns the tube's response to load and velocity; also sets the tube to this shape

  /// `flow`: force density of the solids, and the uniform velocity U (2.46) that is added to the flow. `velocity_integral`: integral over the cell of
  /// the velocity that solids and particles add to the ambient flow (2.49); 0 next to a single plate. `caused`, `caused_integral`: the parts of
  /// `flow` and `velocity_integral` that are due to the particles.
  struct SolidFlow {
    PlatesAndPosts::Flow flow, caused;
    Vec3 velocity_integral = Vec3::Zero(), caused_integral = Vec3::Zero();
  };
  SolidFlow solid_flow();  ///< returns the flow caused by the solids; also sets the solids to this shape
  FluidWalls::Response wall_response();  ///< returns the responses of the tube and the solids; also sets them to this shape

  Tube::Checks checks();                                 ///< returns the errors of the tube's response in the conditions (2.14)

  /// Solves for the unknowns, unless they are known with this error already. Uses the known velocity as initial guess. `error`: allowed error of the
  /// velocity (Capsule::norm per unit of time), if it is larger than the error due to Solvers/tolerance.
  void solve(double error = 0);
  bool solved(double error) const { return solved_ && known_.error <= error; }  ///< returns whether solve(error) would do nothing

  /// Returns the stresslet of particle p (6.7), force x length, with the velocity v of the fluids,
  /// S_ij = int (df_i x_j + df_j x_i)/2 - delta_ij/3 df.x - (1 - lambda) mu (v_i n_j + v_j n_i) dGamma. Batchelor 1970; Pozrikidis 1992, section 5.1.
  Mat3 stresslet(std::size_t p = 0);

  std::vector<double> values_of_added(std::size_t k);  ///< values of the columns of equation k of those that the program adds

  /// Returns the stresslet of the forces between particles by which added equations act, with each force at the centroid of its particle. The
  /// stresslets of the particles refer to these centroids.
  Mat3 stresslet_between_particles();

  /// Returns the power v.C v that the viscosity (3.10) of the membrane or interface of particle p dissipates.
  double membrane_dissipation(std::size_t p = 0);

  /// Returns the energy stored in the membrane of particle p by its loads (membrane::Load), which do not include elasticity and bending.
  double load_energy(std::size_t p = 0);

 private:
  void require_solution();  // solves the linear system, unless it is solved already with any allowed error
  void find_unknowns();
  const WorkOfLoads& work_of_loads();  // virtual work of the loads, and the surface integrals on which they depend
  const Net& solved_fluid_velocity();  // fluid velocity from a solve at this shape, never from `near_`
  const Net& viscous_work();
  Mat3 moment_by_traction(std::size_t p);  // first moment of the load on a body whose unknown is its traction

  Capsule* system_;
  Net x_, given_;  // given_: velocity passed to the constructor
  std::shared_ptr<Evaluation> near_;
  bool solved_ = false;  // true if the system is solved, so that known_ contains its solution
  SolvedShape known_;    // if solved_ is false, contains only the quantities that were used so far
  Net viscous_work_;     // no rows until first used
};

}  // namespace tanktread::coupling
