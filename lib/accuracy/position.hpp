#pragma once
// Distances between surfaces computed on two levels of refinement.

#include <array>
#include <filesystem>
#include <vector>

#include "record/files/stored_surface.hpp"

namespace tanktread::accuracy {

/// Returns the distance of every node of the surface `fine` from the surface `coarse`, found by Gauss-Newton iterations on the cells around the
/// nearest node of `coarse`. The meshes may differ. The distance is NaN if `coarse` has no node within about the largest diameter of its cells.
std::vector<double> distances(const output::StoredSurface& fine, const output::StoredSurface& coarse);

/// Writes the snapshots of the finest level into the directory `to` with the field `position error`: the distance of the surface from that of the
/// level before at the same time, times E_n/(E_(n-1) - E_n) as in (9.1). A snapshot in `to` is not changed if one of the two levels before has no
/// snapshot at this time, or if the largest distances between the three levels do not fall as an estimate requires. `levels`: directories of the last
/// three levels, coarse to fine. `expected`: their expected errors E.
void write_position_errors(const std::array<std::filesystem::path, 3>& levels, const std::vector<double>& expected, const std::filesystem::path& to);

}  // namespace tanktread::accuracy
