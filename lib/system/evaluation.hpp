#pragma once
// What one shape determines, in the hands of the one who asked for it.

#include <memory>
#include <optional>
#include <vector>

#include "base/types.hpp"
#include "system/solids/rigid_particles.hpp"
#include "system/solids/tube.hpp"

namespace tanktread::coupling {

class Capsule;

/// Loads, unknowns and velocities of a shape under the forces that act on it (4.2). Capsule::evaluate makes one with all of them. One that is made of
/// a shape and its velocity computes the others when first asked for them, and solves for the unknowns only where they do not follow from the
/// velocity. Everything stays as it was computed. Nets have a row per control point of all particles. The Capsule must outlive it. Calls are
/// collective.
class Evaluation {
 public:
  /// `velocity`: of the control points, known from elsewhere, for example from the equations of an implicit step; of no rows: not known.
  /// `near`: of nearly the same shape, from which rigid motions and the velocity of fluids that slide along interfaces are taken; or none.
  Evaluation(Capsule& system, Net x, Net velocity = {}, std::shared_ptr<Evaluation> near = nullptr);

  const Net& x() const { return x_; }                    ///< shape, (N, 3)
  const Net& velocity();                                 ///< of the control points, length/time
  const Net& fluid_velocity();                           ///< of the fluids on the surface: `velocity`, unless control points slide
  const Net& work();                                     ///< dE/dx of all loads less the work of forces; 0 of rigid bodies
  const std::vector<Net>& load_sums();                   ///< complete sums of the loads

  /// Load of the fluids on the membranes, as control values: per unstressed or per present area, as its particle says. Of a rigid body the load of
  /// its equation (2.23), a rigid field with the force and torque on the fluid, not the traction.
  const Net& load();

  const RigidParticles& rigid();                         ///< the rigid bodies, as they move there
  const Tube::Response& response();                      ///< what the tube answers to load and velocity; the tube is left placed there
  Tube::Checks checks();                                 ///< of that answer

  /// Solves for the unknowns, started from the known velocity, unless that was done.
  void solve();

  /// Stresslet of particle p (6.7), S_ij = int (df_i x_j + df_j x_i)/2 - delta_ij/3 df.x - (1 - lambda) mu (v_i n_j + v_j n_i) dG, force x length,
  /// with the fluids' velocity v. Batchelor 1970; Pozrikidis 1992, section 5.1.
  Mat3 stresslet(std::size_t p = 0);

  /// Returns v.C v of particle p, the power that the viscosity (3.10) of its membrane or interface turns into heat.
  double membrane_dissipation(std::size_t p = 0);

  /// Returns the energy that the membrane of particle p stores by its loads, without elasticity and bending.
  double load_energy(std::size_t p = 0);

 private:
  friend class Capsule;
  const Net& moving();  // the fluids' velocity at this very shape
  const Net& viscous_work();

  Capsule* system_;
  Net x_, known_;  // known_: the velocity that it was made with
  std::shared_ptr<Evaluation> near_;
  bool solved_ = false;  // load, velocities, unknowns and rigid bodies are there
  Net velocity_, fluid_;  // fluid_: of no rows if no control point slides
  Net unknowns_;          // of the velocity system: the fluids' velocity, of rigid bodies w
  Net work_, load_, viscous_work_;  // of no rows: not asked for yet
  std::vector<Net> load_sums_;
  std::optional<Tube::Response> response_;
  std::optional<RigidParticles> rigid_;
};

}  // namespace tanktread::coupling
