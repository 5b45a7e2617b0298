#pragma once
// Local knots of the spline functions of a T-mesh, Bezier coefficients of these functions on the Bezier mesh, and their generalised Greville points.

#include <array>
#include <vector>

#include "spline/space.hpp"
#include "spline/t_mesh.hpp"

namespace tanktread::spline {

/// Knots of an anchor: reach[k] contains the distances (lattice units) in direction (slot) k to the first and the second vertex with a perpendicular
/// edge (see `touches`). If the first one is an extraordinary point, at the distance d, the second distance is 2 d, as if the mesh were reflected
/// there, because the elements around the point have equal sizes. If the anchor is an extraordinary point, the second distance is also twice the
/// first one. At a pole the end knot is repeated. Lattice::length converts these distances to parametric distances.
struct Knots {
  int reach[4][2];
};
Knots knots(const TMesh& mesh, int anchor);

/// Bezier coefficients of one spline function on one element of the Bezier mesh.
struct Contribution {
  int tile, anchor;
  std::array<double, 16> row;  ///< entry 4 j + i is the coefficient of B_i(s) B_j(t)
};

struct TileFunctions {
  Tiling tiling;                      ///< Bezier mesh
  std::vector<int> anchor;            ///< lattice vertex of each function
  std::vector<int> irregular;         ///< for each element: corner (0 .. 3) that is an extraordinary point, or -1
  std::vector<Contribution> entries;  ///< Bezier coefficients of all functions, in ascending order of the anchor; elements at extraordinary points
                                      ///< have no entries
  std::vector<Knots> knots;           ///< knots of each anchor
};
TileFunctions tile_functions(const TMesh& mesh);

/// A point of a lattice cell with coordinates in thirds of the cell, 0 <= x, y <= 3. All generalised Greville points have this form.
struct CellPoint {
  int cell, x, y;
};
/// Returns the generalised Greville point of an anchor: the mean of its three inner knots in each direction.
CellPoint greville(const TMesh& mesh, int anchor, const Knots& knots);

/// Returns the local coordinates of a point on all mesh elements (tiles) whose closure contains it, in ascending order of the elements.
std::vector<Site> tiles_around(const TMesh& mesh, const Tiling& tiling, const CellPoint& point);

}  // namespace tanktread::spline
