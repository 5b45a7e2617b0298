#pragma once
// A T-mesh with the extensions of its T-junctions, which are updated when edges are added or removed, and the uniform rings around its extraordinary
// points.

#include <map>
#include <set>
#include <utility>

#include "spline/t_mesh.hpp"

namespace tanktread::spline {

/// A T-mesh with the extensions of its T-junctions. Counts violations of the conditions for nested, linearly independent splines:
///  - crossings: pairs of extensions of different axis that meet at a vertex (end points count; an extension that reaches an extraordinary point
///    counts too). If there are none, the mesh is analysis-suitable (Scott et al. 2012).
///  - missing: unit edges of an earlier extended mesh that are neither edges nor covered by an extension. If there are none, the extended meshes are
///    nested.
///  - overlaps: vertices that are not vertices of the T-mesh, on the face extensions of two T-junctions on one line that point at each other.
///    There the extended mesh contains a complete line, and so one smooth function more than the mesh has anchors.
/// If there are none of the three, the spline spaces are nested.
///
/// Adding or removing a path changes only the T-junctions whose extensions meet it. So both operations are cheap and exact inverses of each other.
class ExtendedMesh {
 public:
  explicit ExtendedMesh(TMesh mesh);

  const TMesh& mesh() const { return mesh_; }
  TMesh take() && { return std::move(mesh_); }
  void set_spacing(int point, int h) { mesh_.spacing[point] = h; }

  /// Marks all edges of the current extended mesh as required: the extended mesh must still contain them after later changes. missing() counts the
  /// required edges that it does not contain.
  void keep_extensions();

  void insert(const std::vector<Ray>& path) { change(path, true); }
  void remove(const std::vector<Ray>& path) { change(path, false); }

  int crossings() const { return crossings_; }
  int missing() const { return int(missing_.size()); }

  /// Returns the two T-junctions of the crossing at the first vertex after `cursor`, cyclically. Sets `cursor` to this vertex.
  std::pair<TJunction, TJunction> crossing(int& cursor) const;
  /// Returns the T-junctions on both sides of the first missing edge (one or two).
  std::vector<TJunction> around_missing() const;
  /// Returns the two T-junctions of every overlap, at most `most` pairs, in the order of vertices. Each overlap is listed twice, once from each side.
  std::vector<std::pair<TJunction, TJunction>> facing_pairs(std::size_t most) const;
  int overlaps() const { return int(facing_pairs(passing_.size()).size()) / 2; }

 private:
  struct Trace {  // extensions of one T-junction
    int missing = 0;
    std::vector<Ray> vertices;  // vertices on the extensions, with the slot in the direction of the extension
    std::vector<bool> face;     // true for the elements of `vertices` on the face extension
    std::vector<Ray> edges;
  };
  struct Passing {  // extension that passes a vertex
    int junction;
    int heading;
    bool face;
  };

  void change(const std::vector<Ray>& path, bool present);
  void add(int vertex);
  void erase(int vertex);
  void cover(Ray edge, int by);
  void check_missing(Ray edge);
  int conflicts(int vertex, int heading) const;
  const Passing* facing(int vertex, int heading, int junction) const;
  Ray canonical(Ray edge) const;

  TMesh mesh_;
  std::map<int, Trace> traces_;                       // extensions, by the vertex of the T-junction
  std::vector<std::vector<Passing>> passing_;         // extensions that pass each lattice vertex
  std::vector<std::array<std::uint8_t, 4>> covered_;  // number of extensions over each edge, stored at its canonical end
  std::vector<std::uint8_t> required_;                // edges that must stay covered, bits as in TMesh::edges; empty if there are none
  std::set<std::pair<int, int>> missing_;
  std::set<int> crossed_;  // vertices with crossings
  int crossings_ = 0;
};

/// Returns the indices of the extraordinary points whose zone a path breaks. The zone of a point is the area within `rings` h of it, where the
/// distance is the larger coordinate in the faces at the point. In this zone the mesh must be the uniform h lattice. A path breaks the zone if it has
/// a unit edge there that is not on this lattice. Nested spaces need three rings.
std::vector<int> broken_zones(const TMesh& mesh, const std::vector<Ray>& path, int rings);

/// Returns the middle lines of the twelve elements in the two inner rings at an extraordinary point. If they are added, the zone is uniform with
/// spacing h / 2.
std::vector<std::vector<Ray>> two_ring_cuts(const TMesh& mesh, int point);

/// Halves h of every point whose zone one of the paths breaks. Continues with the lines that this adds, until no zone is broken. Returns the number
/// of halvings.
int restore_zones(ExtendedMesh& extended, std::vector<std::vector<Ray>> paths, int rings);

}  // namespace tanktread::spline
