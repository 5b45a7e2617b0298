#pragma once
// Loads of the membranes and interfaces of all particles, on all ranks.

#include <optional>
#include <utility>
#include <vector>

#include "membrane/mass.hpp"
#include "membrane/mass_solver.hpp"
#include "membrane/membrane.hpp"
#include "system/capsule_parameters.hpp"
#include "system/parallel/row_share.hpp"

namespace tanktread::coupling {

/// The membranes and interfaces of all particles. Computes the virtual work of their stresses, the load (force per area) that has a given virtual
/// work, and the change of the work due to a displacement. Nets have one row per control point; results are equal on all ranks. Calls are collective.
class Membranes {
 public:
  /// References, except `unstressed`, must outlive this object.
  Membranes(const spline::Space& space, const Net& unstressed, const CapsuleParameters& parameters, const RowShare& layout, Phases& phases);

  const membrane::Membrane& membrane() const { return membrane_; }  ///< elasticity and bending
  const Loads& loads() const { return loads_; }                     ///< all other loads
  const Net& unstressed() const { return membrane_.unstressed(); }
  const membrane::MassMatrix& mass_matrix() const { return mass_matrix_; }
  const membrane::SymmetricSolver& mass() const { return mass_.reference(); }  ///< factors of the mass matrix M0 of the unstressed surface
  stokes::Measure measure() const { return coupling::measure(particles_); }    ///< measure of the loads

  /// Returns the net whose area defines the loads (force per area): for each particle, its rows of x or of the unstressed net.
  Net measured_net(const Net& x) const { return coupling::measured_net(particles_, unstressed(), x); }

  /// Returns dE/dx of elasticity, bending and all loads. Sets `sums` to the surface integrals on which some loads depend (`sums` of
  /// membrane::Load::add_work), summed over all ranks.
  Net work(const Net& x, std::vector<Net>& sums) const;

  /// Adds dE/dx of loads() to `work`. On entry, `work` contains this rank's contributions to other terms (elasticity and bending), or zero. On
  /// return, `work` contains the sum of all terms over all ranks. Returns the surface integrals, see work().
  std::vector<Net> complete_work(const Net& x, Net& work) const;

  /// Returns the load with the virtual work `work` on the surface x: per unstressed area (3.7), or per current area (3.6). If `other` is given,
  /// replaces it by M0^-1 times `other`. Where possible, the two systems with M0 are solved in one call, because six columns of right-hand sides are
  /// divided among the ranks more evenly than three.
  Net load(const Net& x, Net work, Net* other = nullptr);
  Net strong_load(const Net& x) const;                                            ///< strong form -div_s tau of the load at the collocation sites
  Net solved(Net work) const { return layout_.solved(mass(), std::move(work)); }  ///< M0^-1 times a net

  bool viscous() const { return viscous_.has_value(); }     ///< true if a membrane or interface is viscous
  Net viscous_work(const Net& x, const Net& v);             ///< virtual work C v of the viscous stresses (3.10) on the surface x
  Net viscous_load(const Net& x, const Net& v) { return load(x, viscous_work(x, v)); }

  /// Sets the shape x for work_change() and viscous_work_change(). `sums`: surface integrals that work() computed at x.
  void linearise(const Net& x, const std::vector<Net>& sums);
  Net work_change(const Net& dx) const;         ///< H dx (4.3), the change of dE/dx due to the displacement dx; 0 for rigid bodies
  Net viscous_work_change(const Net& v) const;  ///< C v

 private:
  Net work_of(const membrane::ViscousLoad& c, const Net& v) const;

  const std::vector<Particle>& particles_;
  const RowShare& layout_;
  Phases& phases_;
  membrane::MassMatrix mass_matrix_;
  membrane::MassSolver mass_;
  membrane::Membrane membrane_;
  Loads loads_;
  membrane::Tangent tangent_;
  std::optional<membrane::ViscousLoad> viscous_, linearised_viscous_;  // ViscousLoad C at viscous_shape_ and at the shape of linearise(); set only
                                                                       // if a membrane or interface is viscous
  Net viscous_shape_;                                                  // shape passed to viscous_work() last
};

}  // namespace tanktread::coupling
