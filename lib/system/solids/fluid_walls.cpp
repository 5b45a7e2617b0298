#include "system/solids/fluid_walls.hpp"

namespace tanktread::coupling {

void FluidWalls::add_velocity_at(const Eigen::SparseMatrix<double>& values, const Net& x, const Tube::Response& response, const Solids::Flow& flow,
                                 std::span<const int> own, Net& u) const {
  Net part(u.rows(), 3);
  if (tube) tube->velocity_at(values, x, response, own, part), u(own, Eigen::all) += part(own, Eigen::all);
  if (solids) solids->velocity_at(values * x, own, flow, part), u(own, Eigen::all) += part(own, Eigen::all);
}

}  // namespace tanktread::coupling
