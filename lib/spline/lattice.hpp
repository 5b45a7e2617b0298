#pragma once
// The lattice under a T-mesh: unit cells, vertices, and which way is straight on.

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "base/types.hpp"

namespace tanktread::spline {

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
};

/// A vertex with the slot in which one goes on.
struct Ray {
  int vertex, slot;
};
/// One unit along a ray, straight on. Not defined when it arrives at an extraordinary point: `slot` is then the way back.
inline Ray step(const Lattice& l, Ray r) {
  const int v = l.neighbour[r.vertex][r.slot], b = l.back[r.vertex][r.slot];
  return {v, l.is_extraordinary[v] ? b : (b + 2) & 3};
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
