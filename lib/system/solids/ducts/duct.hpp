#pragma once
// A duct without particles: the equation of its wall, and the velocity that the wall and the pressure drop cause.

#include <memory>
#include <optional>
#include <utility>

#include "base/types.hpp"
#include "stokes/flow/duct_flow.hpp"
#include "system/solids/ducts/flow_rate.hpp"
#include "system/solids/ducts/wall.hpp"

namespace tanktread::coupling {

/// A duct without particles: its flow, its wall and the viscosity mu of the fluid. Particles cause a velocity at the wall, to which the wall traction
/// f^D and the pressure drop dp respond, (2.5) and (2.6) of Tube. Points and nets are in the frame of the wall. Calls are collective.
class Duct {
 public:
  /// `holds_pressure_drop`: see TubeParameters.
  Duct(std::shared_ptr<const stokes::DuctFlow> flow, std::shared_ptr<Wall> wall, double viscosity, bool holds_pressure_drop)
      : flow_(std::move(flow)), wall_(std::move(wall)), viscosity_(viscosity), holds_pressure_drop_(holds_pressure_drop) {}

  const stokes::DuctFlow& flow() const { return *flow_; }
  Wall& wall() const { return *wall_; }
  double viscosity() const { return viscosity_; }
  double pressure_drop() const { return flow_->pressure_drop(wall_->surface().length()); }  ///< of the empty duct, over its length or one period

  /// Returns c (2.5): the velocity per unit pressure drop, without the velocity due to the traction that the pressure drop causes on the wall.
  Net velocity_per_pressure_drop(const Net& at) const;

  /// Computes rows `points.own` of the velocity -(1/mu) G_W f^D + dp c (2.5) at points off the wall.
  void velocity(const Net& traction, double pressure_drop, const PointsOff& points, Net& u) const;

  /// Returns the wall traction f^D that solves (2.6), by the factors of the wall. `on_wall`: velocity that particles cause at the wall.
  Net traction(const Net& on_wall, double pressure_drop) const {
    return viscosity_ * wall_->solve(on_wall) + pressure_drop * wall_->traction_per_pressure_drop();
  }
  /// Returns the left-hand side of (2.6) minus its right-hand side `on_wall`.
  Net residual(const Net& traction, double pressure_drop, const Net& on_wall) const {
    return (wall_->apply(traction) - pressure_drop * wall_->inlet_column()) / viscosity_ - on_wall;
  }

  /// Returns the flow rate of the duct flow: Q times its current factor `amplitude`. If the pressure drop of the duct flow is prescribed, returns the
  /// flow rate that remains when the particle causes the additional pressure drop dp = `pressure_drop` (2.7): Q (amplitude - dp/dp_0).
  double flow_rate(double pressure_drop, double amplitude) const { return flow_->flow_rate() * (amplitude - flow_rate_reduction(pressure_drop)); }

  /// Returns the fraction dp/dp_0 by which particles reduce the flow rate if the pressure drop of the duct is prescribed, otherwise 0.
  double flow_rate_reduction(double pressure_drop) const { return holds_pressure_drop_ ? pressure_drop / this->pressure_drop() : 0; }

  const FlowRate& disturbed_flow_rate();  ///< returns the flow rate that disturbances cause; set up at the first call

 private:
  std::shared_ptr<const stokes::DuctFlow> flow_;
  std::shared_ptr<Wall> wall_;
  double viscosity_;
  bool holds_pressure_drop_;
  std::optional<FlowRate> disturbed_flow_rate_;
};

}  // namespace tanktread::coupling
