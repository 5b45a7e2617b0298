#pragma once
// The lattice on which a T-mesh is defined: unit cells, vertices, and the directions at each vertex.

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "base/types.hpp"

namespace tanktread::spline {

/// A vertex of the lattice and one of the edges that start there, in the direction with the index `slot` (see Lattice).
struct Ray {
  int vertex, slot;
};

/// Unit quadrilaterals (cells) on a few square macro faces, which are joined along their sides to one closed surface. The lattice does not change;
/// a T-mesh is a subset of its edges. A direction at a vertex is a slot 0 .. 3, counter-clockwise seen from outside (0 .. 2 at an extraordinary
/// point). Even slots lie along one axis, odd slots along the other. Straight on, left and right follow from the slots, so differently oriented
/// face coordinates need no special treatment.
struct Lattice {
  int faces = 0;
  int units = 0;               ///< number of cells of a macro face along its coordinate x; on the cube also along y
  int rows = 0;                ///< number of cells along y, including `pad` rows at each end
  int pad = 0;                 ///< number of rows of zero height (repeated end knots) at each pole; 0 on the cube
  int base = 0;                ///< number of cells along a side of one element of the initial mesh (a power of two)
  std::vector<Vec3> position;  ///< position of each vertex on the cube [-1, 1]^3, or on the unit sphere for polar_lattice

  std::vector<std::array<int, 4>> neighbour;        ///< neighbour of each vertex in direction (slot) k, or -1
  std::vector<std::array<std::uint8_t, 4>> back;    ///< direction at neighbour k that points back to the vertex
  std::vector<std::array<int, 4>> cell;             ///< cell between directions k and k + 1 at each vertex, or -1
  std::vector<std::array<std::uint8_t, 4>> corner;  ///< [v][k]: index 0 .. 3 of the corner of cell[v][k] that is vertex v

  std::vector<std::array<int, 4>> corners;        ///< vertices (x, y), (x+1, y), (x+1, y+1), (x, y+1) of each cell, counter-clockwise from outside
  std::vector<std::array<std::uint8_t, 4>> slot;  ///< direction (slot) from corner k of each cell to its corner k + 1

  std::vector<int> extraordinary;              ///< vertices of valence 3
  std::vector<std::uint8_t> is_extraordinary;  ///< for each vertex, nonzero if it is extraordinary

  std::vector<std::array<int, 4>> point_at;  ///< index in `extraordinary` of the extraordinary point at corner 0 .. 3 of each macro face, or -1

  int vertices() const { return int(neighbour.size()); }
  int cells() const { return int(corners.size()); }
  int valence(int v) const { return is_extraordinary[v] ? 3 : 4; }
  int cell_at(int face, int x, int y) const { return (face * rows + y) * units + x; }
  int face_of(int c) const { return c / (units * rows); }
  int x_of(int c) const { return c % units; }
  int y_of(int c) const { return c / units % rows; }

  /// Returns the height, in lattice units, of the lower border of the cells in row y (index). Rows of zero height at the poles do not contribute.
  int height(int y) const { return std::clamp(y - pad, 0, rows - 2 * pad); }
  bool is_flat(int c) const { return y_of(c) < pad || y_of(c) >= rows - pad; }
  bool ends(int v, int k) const { return neighbour[v][k] < 0; }  ///< whether the polar lattice ends at v in direction (slot) k
  /// Returns the parametric length of `steps` unit edges straight on from vertex v in direction (slot) k. Edges in rows of zero height have length
  /// 0.
  int length(int v, int k, int steps) const;

  /// Returns the edge of the ray r as a ray from the other end of this edge.
  Ray reverse(Ray r) const { return {neighbour[r.vertex][r.slot], back[r.vertex][r.slot]}; }

  /// Returns the side of cell c from corner k to corner k + 1, as a ray.
  Ray side(int c, int k) const { return {corners[c][k], slot[c][k]}; }

  /// Sets or clears an edge at both of its ends. `edges` has one entry per vertex; its bit k is the edge in direction (slot) k.
  void set(std::vector<std::uint8_t>& edges, Ray edge, bool present) const;
};
/// Returns the next ray on the same line, which begins at the other end of the edge of r. If the other end is an extraordinary point, no direction
/// continues the line, and the result points back along the edge of r.
inline Ray step(const Lattice& l, Ray r) {
  const auto [v, back] = l.reverse(r);
  return {v, l.is_extraordinary[v] ? back : (back + 2) & 3};
}

/// A unit edge in the coordinates of a macro face: from (x, y) one step along x if `horizontal`, otherwise along y. `line` is y if the edge is
/// horizontal, otherwise x.
struct PlacedEdge {
  int face, x, y;
  bool horizontal;
  int line() const { return horizontal ? y : x; }
};
PlacedEdge placed(const Lattice& l, Ray edge);

/// Returns the distances of the two ends of an edge from a corner of its face, the smaller distance first. The distance of a point from the corner is
/// the larger of its two coordinate differences.
std::array<int, 2> distances(const Lattice& l, const PlacedEdge& e, int corner);

/// Rotates coordinates by `turn` quarter turns in the square [0, n] x [0, n]: (a, b) are measured from corner `turn`, with a along the side to the
/// next corner. The result is measured from corner 0.
template <class Number>
std::array<Number, 2> turned(Number a, Number b, Number n, int turn) {
  const std::array<Number, 2> places[4] = {{a, b}, {n - b, a}, {n - a, n - b}, {b, n - a}};
  return places[turn & 3];
}

/// A cell and a forward direction. Forward is +x of the face if turn = 0, +y if 1, -x if 2, -y if 3. Left is turn + 1. When the walker crosses a side
/// of a macro face, `turn` changes so that forward remains the same direction on the surface.
struct Walker {
  int cell, turn;
};
/// Returns the walker after n cells forward (`forward`) or to its left (`left`). The walker keeps its forward direction.
Walker forward(const Lattice& l, Walker w, int n);
Walker left(const Lattice& l, Walker w, int n);

/// Returns the lattice on the surface of the cube [-1, 1]^3: with n = `elements_per_side`, six faces of (n 2^levels)^2 cells, 6 (n 2^levels)^2 + 2
/// vertices, eight extraordinary points.
Lattice cube_lattice(int elements_per_side, int levels);

/// Returns a lattice of one face, periodic in x (azimuth) and not periodic in y (from the south pole at y = 0 to the north pole), with a row of cells
/// of zero height at each pole for the repeated end knots. With m azimuthal and r meridional elements, it has m 2^levels by r 2^levels + 2 cells. The
/// index of a vertex is x + y m 2^levels. Positions are on the unit sphere, with the poles on the x3 axis.
Lattice polar_lattice(int azimuthal_elements, int meridional_elements, int levels);

}  // namespace tanktread::spline
