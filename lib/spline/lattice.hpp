#pragma once
// The lattice under a T-mesh: unit cells, vertices, and which way is straight on.

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "base/types.hpp"

namespace tanktread::spline {

/// A vertex with the slot in which one goes on.
struct Ray {
  int vertex, slot;
};

/// Unit quadrilaterals on a few square macro faces, glued along their sides into one closed surface. All of it is fixed; a T-mesh says
/// which of its edges are there. A direction at a vertex is a slot 0 .. 3, counter-clockwise seen from outside (0 .. 2 at an extraordinary
/// point); the parity of a slot is its axis. Nothing here knows of rotations between faces: straight on, left and right are slots.
struct Lattice {
  int faces = 0;
  int units = 0;               ///< cells along x of a macro face; on the cube along y too
  int rows = 0;                ///< cells along y
  int pad = 0;                 ///< of these, at either end of an open face, rows of no height (repeated knots)
  int base = 0;                ///< of these, cells along a side of one base element (a power of two)
  std::vector<Vec3> position;  ///< of a vertex on the cube [-1, 1]^3

  std::vector<std::array<int, 4>> neighbour;        ///< vertex at the other end of slot k; -1: none
  std::vector<std::array<std::uint8_t, 4>> back;    ///< slot there that points back
  std::vector<std::array<int, 4>> cell;             ///< cell between slots k and k + 1; -1: none
  std::vector<std::array<std::uint8_t, 4>> corner;  ///< which corner of that cell this vertex is

  std::vector<std::array<int, 4>> corners;        ///< of a cell: vertices (x, y), (x+1, y), (x+1, y+1), (x, y+1), outward orientation
  std::vector<std::array<std::uint8_t, 4>> slot;  ///< at corner k, the slot that points to corner k + 1

  std::vector<int> extraordinary;              ///< vertices of valence 3
  std::vector<std::uint8_t> is_extraordinary;  ///< of a vertex

  std::vector<std::array<int, 4>> point_at;  ///< of a macro face: number in `extraordinary` of the point at its corner 0 .. 3, or -1

  int vertices() const { return int(neighbour.size()); }
  int cells() const { return int(corners.size()); }
  int valence(int v) const { return is_extraordinary[v] ? 3 : 4; }
  int cell_at(int face, int x, int y) const { return (face * rows + y) * units + x; }
  int face_of(int c) const { return c / (units * rows); }
  int x_of(int c) const { return c % units; }
  int y_of(int c) const { return c / units % rows; }

  /// Parametric height of the horizontal line under row y, in units.
  int height(int y) const { return std::clamp(y - pad, 0, rows - 2 * pad); }
  bool is_flat(int c) const { return y_of(c) < pad || y_of(c) >= rows - pad; }
  bool ends(int v, int k) const { return neighbour[v][k] < 0; }  ///< no way on: the border of an open face
  /// Parametric length of so many unit steps straight on.
  int length(int v, int k, int steps) const;

  /// The same edge from its other end.
  Ray reverse(Ray r) const { return {neighbour[r.vertex][r.slot], back[r.vertex][r.slot]}; }

  /// The side of a cell from corner k to the next.
  Ray side(int c, int k) const { return {corners[c][k], slot[c][k]}; }

  /// Sets or clears an edge among those of all vertices, bit k of a vertex for slot k, at both of its ends.
  void set(std::vector<std::uint8_t>& edges, Ray edge, bool present) const;
};
/// One unit along a ray, straight on. Not defined when it arrives at an extraordinary point: `slot` is then the way back.
inline Ray step(const Lattice& l, Ray r) {
  const auto [v, back] = l.reverse(r);
  return {v, l.is_extraordinary[v] ? back : (back + 2) & 3};
}

/// A unit edge in the frame of a macro face: from (x, y) one step along x (or y), on the line with this number.
struct PlacedEdge {
  int face, x, y;
  bool horizontal;
  int line() const { return horizontal ? y : x; }
};
PlacedEdge placed(const Lattice& l, Ray edge);

/// How far the nearer and the farther end of an edge are from a corner of its face, by the larger coordinate.
std::array<int, 2> distances(const Lattice& l, const PlacedEdge& e, int corner);

/// The place (a, b) in a square of side n whose corner `turn` is the origin and whose side from there on is the first axis, seen from corner 0.
template <class Number>
std::array<Number, 2> turned(Number a, Number b, Number n, int turn) {
  const std::array<Number, 2> places[4] = {{a, b}, {n - b, a}, {n - a, n - b}, {b, n - a}};
  return places[turn & 3];
}

/// A cell seen from a walker who calls one of four directions "forward": turn = 0 forward is +x of the face, 1: +y, 2: -x, 3: -y; left is
/// turn + 1. Walking over a side of a macro face changes the turn, not the walker's mind.
struct Walker {
  int cell, turn;
};
/// n cells forward (or to the left).
Walker forward(const Lattice& l, Walker w, int n);
Walker left(const Lattice& l, Walker w, int n);

/// Surface of the cube [-1, 1]^3, six faces of (n 2^levels)^2 cells, 6 (n 2^levels)^2 + 2 vertices, eight extraordinary points.
Lattice cube_lattice(int elements_per_side, int levels);

/// One face, periodic in x (azimuth) and open in y (from the south pole at y = 0 to the north pole), with a row of no height at either end for
/// the repeated end knots: m 2^levels by r 2^levels + 2 cells. Vertex x + y m 2^levels. Positions on the unit sphere, poles on x3.
Lattice polar_lattice(int azimuthal_elements, int meridional_elements, int levels);

}  // namespace tanktread::spline
