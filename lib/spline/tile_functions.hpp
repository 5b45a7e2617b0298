#pragma once
// The spline functions of a T-mesh on the elements of its Bezier mesh, and their generalised Greville points there.

#include <array>
#include <vector>

#include "spline/knots.hpp"
#include "spline/space.hpp"

namespace tanktread::spline {

/// Bezier coefficients of one function on one element.
struct Contribution {
  int tile, anchor;
  std::array<double, 16> row;  ///< 4 j + i
};

struct TileFunctions {
  Tiling tiling;                      ///< the Bezier mesh
  std::vector<int> anchor;            ///< lattice vertex of each function
  std::vector<int> irregular;         ///< of a tile: its corner at an extraordinary point, or -1
  std::vector<Contribution> entries;  ///< on regular tiles, by ascending anchor; functions at irregular ones are not tensor products
  std::vector<Knots> knots;           ///< of each anchor
};
TileFunctions tile_functions(const TMesh& mesh);

/// A point of a cell in thirds of a unit, 0 <= x, y <= 3: generalised Greville points are such.
struct CellPoint {
  int cell, x, y;
};
/// The means of the three inner knots of an anchor in each direction.
CellPoint greville(const TMesh& mesh, int anchor, const Knots& knots);

/// Every tile whose closure holds a point, with the local coordinates there, by ascending tile.
std::vector<Site> tiles_around(const TMesh& mesh, const Tiling& tiling, const CellPoint& point);

}  // namespace tanktread::spline
