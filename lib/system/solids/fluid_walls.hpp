#pragma once
// The walls and other solids that bound the fluid, as seen by particles.

#include <span>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "system/solids/ducts/tube.hpp"
#include "system/solids/plates/solid_response.hpp"

namespace tanktread::coupling {

/// Boundaries of the fluid that are meshed, other than particles. A member is null if there is no such boundary.
struct FluidWalls {
  Tube* tube = nullptr;
  SolidResponse* solids = nullptr;

  /// Adds to rows `own` of u the velocity that tube and solids cause at points on the particles. `values`: values of the basis functions at the
  /// points. x: net of the particles. `response`, `flow`: responses of tube and solids. Collective if Tube::velocity_at() is.
  void add_velocity_at(const Eigen::SparseMatrix<double>& values, const Net& x, const Tube::Response& response, const Solids::Flow& flow,
                       std::span<const int> own, Net& u) const;
};

}  // namespace tanktread::coupling
