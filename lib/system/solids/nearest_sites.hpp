#pragma once
// Collocation points of particles that are nearest to points on a wall.

#include <span>
#include <vector>

#include "base/types.hpp"
#include "stokes/medium/periodic_images.hpp"

namespace tanktread::coupling {

/// Returns, for each target in `rows`, the index of the nearest site; 0 for all other targets. If a cell is given, periodic images of the sites are
/// included. `sites` and `targets`: positions of shape (n, 3) and (m, 3), units length.
std::vector<int> nearest_sites(const Net& sites, const Net& targets, std::span<const int> rows, const stokes::PeriodicCell* cell);

}  // namespace tanktread::coupling
