#include "system/solids/fluid_walls.hpp"

#include "system/solids/ducts/duct.hpp"

namespace tanktread::coupling {

void FluidWalls::set_shape(const Net& x, const Targets& targets, std::optional<double> origin) const {
  if (tube) tube->set_shape(x, origin);
  if (solids) solids->set_shape(x, targets.values() * x, targets.own());
}

void FluidWalls::forget() const {
  if (tube) tube->forget();
  if (solids) solids->forget();
}

FluidWalls::Crossing FluidWalls::crossing(const Net& at, const RowShare& layout) const {
  if (tube) return {tube->duct().wall().first_outside(at, layout.points()), "the wall of the duct"};
  return solids ? solids->scene().solids->crossing(at) : Crossing();
}

FluidWalls::Response FluidWalls::respond(const Net& f, const Net& v, bool with_empty) const {
  Response found;
  if (solids) found.solids = solids->respond(f, v);
  if (solids && with_empty) found.solids = found.solids + solids->empty();
  if (tube) found.tube = tube->respond(f, v);
  return found;
}

void FluidWalls::add_velocity(const Response& response, const Targets& targets, Net& u) const {
  if (tube) u += response.tube.velocity;
  if (!solids) return;
  Net part = targets.zero();
  solids->velocities(response.solids, part);
  targets.gather(false, part);
  u += part;
}

void FluidWalls::add_velocity_at(const Eigen::SparseMatrix<double>& values, const Net& x, const Response& response, std::span<const int> own,
                                 Net& u) const {
  Net part(u.rows(), 3);
  if (tube) tube->velocity_at(values, x, response.tube, own, part), u(own, Eigen::all) += part(own, Eigen::all);
  if (!solids) return;
  solids->scene().solids->velocity_at({.at = values * x, .own = {own.begin(), own.end()}}, response.solids, part);
  u(own, Eigen::all) += part(own, Eigen::all);
}

stokes::Evaluations FluidWalls::evaluations() const {
  stokes::Evaluations sum;
  if (tube) sum += tube->kernel_evaluations();
  if (solids) sum += solids->evaluations();
  return sum;
}

}  // namespace tanktread::coupling
