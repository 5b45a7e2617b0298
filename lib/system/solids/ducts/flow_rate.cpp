#include "system/solids/ducts/flow_rate.hpp"

#include "system/targets/layer_pair.hpp"

namespace tanktread::coupling {

FlowRate::FlowRate(const Wall& wall, double viscosity, double own) : wall_(wall), viscosity_(viscosity), own_(own) {
  const auto integrals = [&](const auto& field) { return wall.from_space(wall_integrals(wall.surface(), field)); };
  of_traction_ = integrals([&](const surface::Point& at) -> Vec3 { return of_forces(Net(at.x.transpose())).row(0).transpose(); });
  force_ = integrals([](const surface::Point&) -> Vec3 { return Vec3::UnitX(); });
  if (!wall.iterates()) of_velocity_ = wall.solve_transposed(of_traction_);
  per_pressure_drop_ = of_answer(wall.traction_per_pressure_drop(), 1);
}

double FlowRate::of_answer(const Net& traction, double pressure_drop) const {
  return (pressure_drop * own_ - dot(of_traction_, traction)) / viscosity_;
}

/// Returns mu times the flow rate along the duct due to a unit force, one row per point of `at` and one column per direction of the force. If the
/// wall is open, this is the integral c (2.13) over the inlet. If the wall is periodic with the period L, this is -rho^2/(4 L) e1, where rho is the
/// distance from the axis x1 (2.44). In this case only the flow rate of several forces together is meaningful, and these forces must sum to 0.
Net FlowRate::of_forces(const Net& at) const {
  if (!wall_.cell()) return wall_.inlet().integral(at);
  Net flow = Net::Zero(at.rows(), 3);
  flow.col(0) = -at.rightCols<2>().rowwise().squaredNorm() / (4 * wall_.surface().period);
  return flow;
}

double FlowRate::of_load(const Net& f, const LayerPair& particles) const {
  return -dot(particles.weights_of_load([this](const Net& x) { return of_forces(x); }), f) / viscosity_;
}

/// The field is the flow rate that a double layer of unit strength at the point x with normal n causes, one entry per component of the strength. If
/// the wall is open, this is the flow rate through the inlet. If it is periodic with the period L, this is (x1 n - ((n.rho) e1 + n1 rho)/2)/L, where
/// rho is the vector from the axis x1 to the point (2.45). In this case only the integral over a surface is meaningful, and the total flux of the
/// strength through this surface must be 0.
Net FlowRate::weights_of_velocity(const LayerPair& particles) const {
  return particles.weights_of_velocity([this](const Net& x, const Net& normals) {
    Net flow(x.rows(), 3);
    for (Eigen::Index k = 0; k < x.rows(); ++k) {
      const Vec3 n = normals.row(k).transpose(), across(0, x(k, 1), x(k, 2));
      flow.row(k) = (wall_.cell() ? Vec3((x(k, 0) * n - (n.dot(across) * Vec3::UnitX() + n[0] * across) / 2) / wall_.surface().period)
                                  : wall_.inlet().double_layer_flow(x.row(k).transpose(), n)).transpose();
    }
    return flow;
  });
}

double FlowRate::stopping_pressure_drop(const Net& on_wall, double flow) const {
  const double taken_away = wall_.iterates() ? dot(of_traction_, wall_.solve(on_wall)) : dot(of_velocity_, on_wall);
  return (taken_away - flow) / per_pressure_drop_;
}

}  // namespace tanktread::coupling
