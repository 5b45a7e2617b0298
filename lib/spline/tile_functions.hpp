#pragma once
// The local knots of the spline functions of a T-mesh, the functions on the elements of its Bezier mesh, and their generalised Greville points there.

#include <array>
#include <vector>

#include "spline/space.hpp"
#include "spline/t_mesh.hpp"

namespace tanktread::spline {

/// In each slot of an anchor, the distances (lattice units) to the first and second perpendicular touch. A ray that runs into an extraordinary
/// point first gets d, 2 d (mirror: the rings there are uniform), and so does every slot of such a point. Beyond the border of an open face the
/// end knot is repeated. Parametric distances: Lattice::length.
struct Knots {
  int reach[4][2];
};
Knots knots(const TMesh& mesh, int anchor);

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
