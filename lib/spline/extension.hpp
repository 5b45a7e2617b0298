#pragma once
// T-junctions and their extensions.

#include "spline/t_mesh.hpp"

namespace tanktread::spline {

/// A vertex with exactly three of its four edges; `missing` is the slot of the fourth.
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

}  // namespace tanktread::spline
