#pragma once
// Distances between surfaces computed on two levels of refinement.

#include <filesystem>
#include <vector>

#include "record/files/stored_surface.hpp"

namespace tanktread::accuracy {

/// Returns the distance of every node of the surface `fine` from the surface `coarse`, found by Gauss-Newton iterations on the cells around the
/// nearest node of `coarse`. The meshes may differ. The distance is NaN if `coarse` has no node within about the largest diameter of its cells.
std::vector<double> distances(const output::StoredSurface& fine, const output::StoredSurface& coarse);

/// Writes the snapshots of `fine` into the directory `to` with the field `position error`: the distance of the surface from the snapshot of `coarse`
/// at the same time, times `factor`. If `coarse` has no snapshot at this time, the snapshot in `to` is not changed.
void write_position_errors(const std::filesystem::path& fine, const std::filesystem::path& coarse, const std::filesystem::path& to, double factor);

}  // namespace tanktread::accuracy
