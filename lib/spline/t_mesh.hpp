#pragma once
// A T-mesh: a subset of the edges of a lattice, which determines the vertices, T-junctions, elements and knots.

#include <memory>

#include "spline/lattice.hpp"

namespace tanktread::spline {

/// A checkpoint stores `edges` and `spacing`. To restore the mesh, assign them to the mesh that cube() or polar() returns for the same arguments.
struct TMesh {
  std::shared_ptr<const Lattice> lattice;
  /// bit k of entry v is set if the unit edge in direction (slot) k at lattice vertex v exists; each edge is stored at both of its ends
  std::vector<std::uint8_t> edges;
  std::vector<int> spacing;  ///< spacing h at each extraordinary point: within 3 h of it the mesh is a uniform lattice of spacing h

  bool edge(int v, int k) const { return edges[v] >> k & 1; }
  bool edge_of_cell(int c, int k) const { return edge(lattice->corners[c][k], lattice->slot[c][k]); }
  void set(Ray edge, bool present) { lattice->set(edges, edge, present); }
};

/// Returns the uniform mesh on the surface of a cube with n^2 elements per face, n = `elements_per_side` >= 3. The lattice permits `levels`
/// bisections of each element. Spline spaces are in extraction.hpp. Throws UserError if n < 3 (the rings of elements around different extraordinary
/// points would overlap) or the lattice is too large: more than 12 levels, or n 2^levels above 1536.
TMesh cube(int elements_per_side, int levels = 0);

/// Returns the uniform mesh on a sphere with two poles: m = `azimuthal_elements` in azimuth and r = `meridional_elements` from pole to pole. The
/// lattice permits `levels` bisections of each element. Spline spaces are in polar.hpp. Throws UserError if m < 4, r < 4, or the lattice is too
/// large: more than 12 levels, or m 2^levels or r 2^levels above 4096.
TMesh polar(int azimuthal_elements, int meridional_elements, int levels = 0);

/// Returns whether the vertex is an anchor, which means that it has a control point: mesh edges of both directions meet there. T-junctions and
/// extraordinary points are anchors.
bool is_anchor(const TMesh& mesh, int vertex);

/// Returns the lattice vertices of the control points in ascending order: 6 n^2 + 2 vertices on the uniform cube with n^2 elements per face. Control
/// point i of space(mesh, ...) is at vertex anchors(mesh)[i].
std::vector<int> anchors(const TMesh& mesh);

/// Returns the inverse of anchors(mesh): the control point at each lattice vertex, or -1.
std::vector<int> control_points(const TMesh& mesh);

/// Element of a mesh: the lattice cells x .. x + width - 1, y .. y + height - 1 of a macro face (face of the cube).
struct Rectangle {
  int face, x, y, width, height;
};
/// Returns the sides of a rectangle as rays from the corners (x, y), (x+w, y), (x+w, y+h) and (x, y+h), with the width w and height h of r. Each ray
/// points to the next corner, counter-clockwise seen from outside.
std::array<Ray, 4> sides(const Lattice& lattice, const Rectangle& r);

/// Returns whether a side of the rectangle is collapsed to a pole.
bool is_degenerate(const Lattice& lattice, const Rectangle& r);

/// Rectangular elements (tiles) into which the mesh edges divide the faces, and for each lattice cell the element that contains it.
struct Tiling {
  std::vector<Rectangle> tiles;
  std::vector<int> tile_of_cell;
};

/// T-junction: a vertex with exactly three of its four edges. `missing` is the direction (slot) of the fourth.
struct TJunction {
  int vertex, missing;
};
std::vector<TJunction> t_junctions(const TMesh& mesh);

/// Returns the direction (slot) of the missing edge if the vertex is a T-junction, otherwise -1.
int missing_slot(const TMesh& mesh, int vertex);

/// Returns whether a line in the direction of the ray meets a perpendicular edge (a touch) at the vertex. An edge on one side is enough.
inline bool touches(const TMesh& mesh, Ray r) { return mesh.edges[r.vertex] & (r.slot & 1 ? 5 : 10); }

/// Returns the unit edges (vertex, slot) of an extension of a T-junction. A touch is a vertex with a perpendicular edge, and a bay is the part of a
/// line between two successive touches. The face extension has two bays in the missing direction, up to the second touch. The edge extension has
/// one bay in the opposite direction.
std::vector<Ray> face_extension(const TMesh& mesh, const TJunction& t);
std::vector<Ray> edge_extension(const TMesh& mesh, const TJunction& t);

/// Returns the elements of the T-mesh, which can be marked for refinement.
Tiling elements(const TMesh& mesh);

/// Returns the elements of the Bezier mesh, which is the T-mesh with the face extensions of its T-junctions. On each of them every spline function is
/// a single bicubic polynomial.
Tiling bezier_mesh(const TMesh& mesh);

}  // namespace tanktread::spline
