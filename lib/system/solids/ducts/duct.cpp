#include "system/solids/ducts/duct.hpp"

#include "system/targets/points_off.hpp"

namespace tanktread::coupling {

Net Duct::velocity_per_pressure_drop(const Net& at) const {
  return wall_->cell() ? Net(flow_->velocities(at) / pressure_drop()) : Net(wall_->inlet().integral(at) / viscosity_);
}

void Duct::velocity(const Net& traction, double pressure_drop, const PointsOff& points, Net& u) const {
  wall_->velocity(traction, points, u);
  // The flow of a periodic channel is collective: every rank evaluates it at all points.
  const Net by_pressure = wall_->cell() ? Net(velocity_per_pressure_drop(points.at)(points.own, Eigen::all))
                                        : velocity_per_pressure_drop(points.at(points.own, Eigen::all));
  for (std::size_t k = 0; k < points.own.size(); ++k) {
    const int i = points.own[k];
    u.row(i) = pressure_drop * by_pressure.row(static_cast<Eigen::Index>(k)) - u.row(i) / viscosity_;
  }
}

const FlowRate& Duct::disturbed_flow_rate() {
  if (!disturbed_flow_rate_) {
    const double own = wall_->cell() ? viscosity_ * flow_->flow_rate() / pressure_drop() : wall_->inlet().own_flow();
    disturbed_flow_rate_.emplace(*wall_, viscosity_, own);
  }
  return *disturbed_flow_rate_;
}

}  // namespace tanktread::coupling
