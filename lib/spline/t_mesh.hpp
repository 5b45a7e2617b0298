#pragma once
// A T-mesh on a lattice: which lattice edges are there. Everything else (vertices, T-junctions, elements, knots) follows.

#include <memory>

#include "spline/lattice.hpp"

namespace tanktread::spline {

/// A checkpoint of a mesh is `edges` and `spacing`; put into the mesh that cube() or polar() makes from the same arguments, they restore it.
struct TMesh {
  std::shared_ptr<const Lattice> lattice;
  std::vector<std::uint8_t> edges;  ///< of a lattice vertex: bit k set when the unit edge in slot k is there; the same at both ends
  std::vector<int> spacing;         ///< h of each extraordinary point: within 3 h of it the mesh is the uniform h lattice

  bool edge(int v, int k) const { return edges[v] >> k & 1; }
  bool edge_of_cell(int c, int k) const { return edge(lattice->corners[c][k], lattice->slot[c][k]); }
  void set(Ray edge, bool present) { lattice->set(edges, edge, present); }
};

/// The uniform mesh on the surface of a cube: n^2 elements a face, n >= 3, and room for `levels` bisections of each element; spaces by
/// extraction.hpp. Throws UserError when n < 3 (rings of extraordinary points would meet) or when the lattice would not fit into memory.
TMesh cube(int elements_per_side, int levels = 0);

/// The uniform mesh on a sphere with two poles: m elements around, r from pole to pole, and room for `levels` bisections; spaces by polar.hpp.
/// Throws UserError when m < 4 or r < 4, or when the lattice would not fit into memory.
TMesh polar(int azimuthal_elements, int meridional_elements, int levels = 0);

/// Whether a control point sits at the vertex: edges on both axes (T-junctions and extraordinary points included).
bool is_anchor(const TMesh& mesh, int vertex);

/// Lattice vertex of every control point, ascending; 6 n^2 + 2 of them on the uniform cube. Control point i of space(mesh, ...) is
/// anchors(mesh)[i].
std::vector<int> anchors(const TMesh& mesh);

/// The inverse: control point at a lattice vertex, or -1.
std::vector<int> control_points(const TMesh& mesh);

/// An element of a mesh: cells x .. x + width - 1, y .. y + height - 1 of a macro face.
struct Rectangle {
  int face, x, y, width, height;
};
/// Its sides k, each by the ray along the first cell of it: from corner (x, y), (x+w, y), (x+w, y+h), (x, y+h) towards the next, outward orientation.
std::array<Ray, 4> sides(const Lattice& lattice, const Rectangle& r);

/// Whether one of its sides is a pole.
bool is_degenerate(const Lattice& lattice, const Rectangle& r);

/// Rectangles into which the edges cut the faces, and the one that holds each cell.
struct Tiling {
  std::vector<Rectangle> tiles;
  std::vector<int> tile_of_cell;
};

/// A T-junction: a vertex with exactly three of its four edges; `missing` is the slot of the fourth.
struct TJunction {
  int vertex, missing;
};
std::vector<TJunction> t_junctions(const TMesh& mesh);

/// The missing slot if the vertex is a T-junction, -1 otherwise.
int missing_slot(const TMesh& mesh, int vertex);

/// Whether a ray that arrives (its slot goes on) meets an edge perpendicular to it; a vertex on either side counts.
inline bool touches(const TMesh& mesh, Ray r) { return mesh.edges[r.vertex] & (r.slot & 1 ? 5 : 10); }

/// The unit edges (vertex, slot) of an extension: from the T-junction through two bays in its missing direction, up to the second
/// perpendicular touch; or through one bay the other way.
std::vector<Ray> face_extension(const TMesh& mesh, const TJunction& t);
std::vector<Ray> edge_extension(const TMesh& mesh, const TJunction& t);

/// Elements of the T-mesh (the ones that are marked for refinement).
Tiling elements(const TMesh& mesh);

/// Elements of the Bezier mesh: the T-mesh with the face extensions of its T-junctions; on each of them every spline function is one
/// bicubic.
Tiling bezier_mesh(const TMesh& mesh);

}  // namespace tanktread::spline
