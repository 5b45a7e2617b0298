#pragma once
// Distances between surfaces computed on two levels of refinement.

#include <filesystem>
#include <vector>

#include "record/files/stored_surface.hpp"

namespace tanktread::accuracy {

/// Returns the distance of every node of a surface from another surface, found by Gauss-Newton iterations on the cells around the nearest node. The
/// meshes may differ. NaN if the other surface has no node within the largest diameter of its cells.
std::vector<double> distances(const output::StoredSurface& fine, const output::StoredSurface& coarse);

/// Writes the snapshots of `fine` into the directory `to` with the field `position error`: the distance of the surface from the snapshot of `coarse`
/// at the same time, times `factor`. Snapshots without a counterpart are left as they are.
void write_position_errors(const std::filesystem::path& fine, const std::filesystem::path& coarse, const std::filesystem::path& to, double factor);

}  // namespace tanktread::accuracy
