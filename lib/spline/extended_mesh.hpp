#pragma once
// A T-mesh with the extensions of its T-junctions, which are updated when edges are added or removed. Also functions that keep the mesh uniform in
// layers of elements (rings) around its extraordinary points.

#include <map>
#include <set>
#include <utility>

#include "spline/t_mesh.hpp"

namespace tanktread::spline {

/// A T-mesh with the extensions of its T-junctions: lines that continue the edge that ends there into the mesh (Scott et al. 2012). Counts
/// violations of the conditions for nested, linearly independent splines:
///  - crossings: pairs of extensions along different axes that meet at a vertex. An extension includes its two end points. An extension that
///    reaches an extraordinary point also counts as a crossing. A mesh without crossings is analysis-suitable (Scott et al. 2012).
///  - missing: edges of the lattice that an earlier extended mesh (T-mesh plus extensions) contains and the current one does not contain. If no edge
///    is missing, the extended meshes are nested.
///  - overlaps: lattice vertices at which the face extensions of two T-junctions overlap. The two T-junctions are on one line and point at each
///    other, and together their extensions connect them by an unbroken line. The vertex is on an edge perpendicular to this line, but it is not a
///    vertex of the T-mesh. The space of smooth splines on the extended mesh then has one dimension more than there are anchors (vertices with a
///    control point).
/// If all three counts are 0, the spline spaces are nested.
///
/// Adding or removing a path of edges changes only the T-junctions whose extensions meet the path. So both operations are cheap and exact inverses of
/// each other.
class ExtendedMesh {
 public:
  explicit ExtendedMesh(TMesh mesh);

  const TMesh& mesh() const { return mesh_; }
  TMesh take() && { return std::move(mesh_); }
  void set_spacing(int point, int h) { mesh_.spacing[point] = h; }

  /// Records all edges of the current extended mesh as required: the extended mesh must contain them after all later changes. missing() returns the
  /// number of required edges that the current extended mesh does not contain.
  void keep_extensions();

  void insert(const std::vector<Ray>& path) { change(path, true); }
  void remove(const std::vector<Ray>& path) { change(path, false); }

  int crossings() const { return crossings_; }
  int missing() const { return int(missing_.size()); }

  /// Finds the first vertex with an index above `cursor` (cyclically) at which two extensions cross, and returns their T-junctions. Sets `cursor` to
  /// this vertex.
  std::pair<TJunction, TJunction> crossing(int& cursor) const;
  /// Returns the T-junctions whose extensions could be lengthened to contain the first missing edge (see keep_extensions). These T-junctions lie on
  /// the line of this edge, at most one in each direction.
  std::vector<TJunction> around_missing() const;
  /// Returns pairs of T-junctions that point at each other and whose extensions overlap, at most `most` pairs, in the order of vertices. Each
  /// overlap is listed twice, once from each side.
  std::vector<std::pair<TJunction, TJunction>> facing_pairs(std::size_t most) const;
  int overlaps() const { return int(facing_pairs(passing_.size()).size()) / 2; }

 private:
  struct Trace {  // extensions of one T-junction
    int missing = 0;
    std::vector<Ray> vertices;  // vertices on the extensions, each with the direction in which the extension leaves it
    std::vector<bool> face;     // for each entry of `vertices`: true on the face extension, false on the edge extension
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
  std::map<int, Trace> traces_;                       // extensions of each T-junction, by the lattice vertex of the T-junction
  std::vector<std::vector<Passing>> passing_;         // extensions that pass each lattice vertex
  std::vector<std::array<std::uint8_t, 4>> covered_;  // number of extensions that contain each unit edge, stored at one of its two ends
  // unit edges that the extended mesh must contain; bit k of entry v: edge k at vertex v; empty before keep_extensions()
  std::vector<std::uint8_t> required_;
  std::set<std::pair<int, int>> missing_;
  std::set<int> crossed_;  // vertices with crossings
  int crossings_ = 0;
};

/// Returns the indices of the extraordinary points whose zone is broken by a path of new edges. The zone of an extraordinary point consists of one
/// square per face at the point. Each square has a corner at the point, and its side is `rings` times the spacing h of the point. In the zone, the
/// mesh must be the uniform lattice of spacing h. A path breaks the zone if it has an edge there that is not on this lattice. Spline spaces are
/// nested under refinement only if `rings` is 3.
std::vector<int> broken_zones(const TMesh& mesh, const std::vector<Ray>& path, int rings);

/// Returns the lines that bisect the twelve elements in the two innermost rings around an extraordinary point. If these lines are added, the rings
/// are uniform with the spacing h/2.
std::vector<std::vector<Ray>> two_ring_cuts(const TMesh& mesh, int point);

/// If one of the paths of edges breaks the zone of an extraordinary point (see broken_zones), adds mesh lines that halve the spacing h of this point.
/// Repeats this for the added lines until no zone is broken. Returns how many times a spacing was halved.
int restore_zones(ExtendedMesh& extended, std::vector<std::vector<Ray>> paths, int rings);

}  // namespace tanktread::spline
