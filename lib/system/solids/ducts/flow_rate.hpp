#pragma once
// Flow rate along a duct and axial force of a disturbance.

#include "base/types.hpp"
#include "system/solids/ducts/wall.hpp"

namespace tanktread::coupling {

class LayerPair;

/// Flow rate along a duct and axial force of a disturbance, as linear functions of what causes the disturbance. By reciprocity, a force f at y
/// causes the flow rate f.c(y)/mu, with c of (2.13) through the inlet or of (2.44) in a periodic duct. Therefore no quadrature over a cross-section
/// is needed.
class FlowRate {
 public:
  /// `own`: flow rate of the velocity field mu c of (2.5), the flow that a unit pressure drop causes without the wall. `wall` must outlive this
  /// object.
  FlowRate(const Wall& wall, double viscosity, double own);

  /// Returns the flow rate that a wall traction and a pressure drop cause.
  double of_answer(const Net& traction, double pressure_drop) const;

  double of_load(const Net& f, const LayerPair& particles) const;  ///< returns the flow rate that the load f of particles causes

  /// Returns weights w, one row per control point: the double layer of particles with the velocity v causes the flow rate w.v.
  Net weights_of_velocity(const LayerPair& particles) const;

  /// Returns the pressure drop for which a disturbance has zero flow rate. The disturbance causes the velocity `on_wall` at the wall and, without the
  /// answer of the wall, the flow rate `flow`.
  double stopping_pressure_drop(const Net& on_wall, double flow) const;

  double per_pressure_drop() const { return per_pressure_drop_; }  ///< flow rate per unit pressure drop, with the wall traction that it causes
  /// Returns weights w for a velocity u on the wall: w.u is the flow rate of the wall traction that cancels u. Needs the factors of the wall.
  const Net& weights_of_wall_velocity() const { return of_velocity_; }
  double force(const Net& traction) const { return dot(force_, traction); }  ///< axial force of a wall traction

 private:
  Net of_forces(const Net& at) const;

  const Wall& wall_;
  double viscosity_, own_;
  Net of_traction_;  // weights of the wall traction in mu times the flow rate
  Net force_;        // weights of the wall traction in the axial force
  Net of_velocity_;  // see weights_of_wall_velocity(); no rows if the equation of the wall is solved by iteration
  double per_pressure_drop_;
};

}  // namespace tanktread::coupling
