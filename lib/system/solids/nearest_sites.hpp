#pragma once
// Collocation points of particles that are nearest to points on a wall.

#include <span>
#include <vector>

#include "base/types.hpp"
#include "stokes/medium/periodic_images.hpp"

namespace tanktread::coupling {

/// Returns, for these rows of `targets`, the row of `sites` that is nearest; 0 for other rows. With a cell, images of the sites count too. `sites`
/// and `targets`: positions of shape (n, 3) and (m, 3), units length.
std::vector<int> nearest_sites(const Net& sites, const Net& targets, std::span<const int> rows, const stokes::PeriodicCell* cell);

}  // namespace tanktread::coupling
