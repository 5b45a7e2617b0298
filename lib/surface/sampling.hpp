#pragma once
// Places of an element on a regular grid.

#include <array>

#include "base/types.hpp"
#include "surface/patch.hpp"

namespace tanktread::surface {

constexpr int cells = 6;  ///< intervals of the grid, a direction

/// Places at (i, j)/cells, [j][i].
using Grid = std::array<std::array<Vec3, cells + 1>, cells + 1>;
Grid sample(const Patch& patch);

}  // namespace tanktread::surface
