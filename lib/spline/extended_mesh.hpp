#pragma once
// A T-mesh with the extensions of its T-junctions, kept up to date while edges are put in or taken out; and the uniform rings around its
// extraordinary points.

#include <map>
#include <set>
#include <utility>

#include "spline/t_mesh.hpp"

namespace tanktread::spline {

/// Counts what stands between a T-mesh and nested, linearly independent splines:
///  - crossings: pairs of extensions of different axis that meet in a vertex (end points count; an extension that reaches an extraordinary point
///    counts too). None: the mesh is analysis-suitable (Scott et al. 2012).
///  - missing: unit edges of an earlier extended mesh that are neither edges nor covered by an extension. None: the extended meshes are nested.
///  - overlaps: vertices that are no T-mesh vertex, on the face extensions of two T-junctions of one line that point at each other. There the
///    extended mesh carries a whole line and one smooth function more than the mesh has anchors.
/// Together none of the three: the spline spaces are nested.
///
/// Adding or removing a path touches only the T-junctions whose extensions meet it, so both are cheap and exact inverses of each other.
class ExtendedMesh {
 public:
  explicit ExtendedMesh(TMesh mesh);

  const TMesh& mesh() const { return mesh_; }
  TMesh take() && { return std::move(mesh_); }
  void set_spacing(int point, int h) { mesh_.spacing[point] = h; }

  /// Requires from now on that every edge of the present extended mesh stays covered.
  void keep_extensions();

  void insert(const std::vector<Ray>& path) { change(path, true); }
  void remove(const std::vector<Ray>& path) { change(path, false); }

  int crossings() const { return crossings_; }
  int missing() const { return int(missing_.size()); }

  /// The two T-junctions of the crossing at the first vertex from `cursor` on, cyclically; the vertex becomes the next cursor's predecessor.
  std::pair<TJunction, TJunction> crossing(int& cursor) const;
  /// The T-junctions on both sides of the first missing edge (one or two).
  std::vector<TJunction> around_missing() const;
  /// The two T-junctions of every overlap, at most so many, in the order of vertices. Each overlap comes twice, seen from either side.
  std::vector<std::pair<TJunction, TJunction>> facing_pairs(std::size_t most) const;
  int overlaps() const { return int(facing_pairs(passing_.size()).size()) / 2; }

 private:
  struct Trace {  // of one T-junction
    int missing = 0;
    std::vector<Ray> vertices;  // passed, with the slot that goes on
    std::vector<bool> face;     // whether on the face extension
    std::vector<Ray> edges;
  };
  struct Passing {  // an extension that passes a vertex
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
  std::map<int, Trace> traces_;                       // by vertex of the T-junction
  std::vector<std::vector<Passing>> passing_;         // of a lattice vertex
  std::vector<std::array<std::uint8_t, 4>> covered_;  // extensions over an edge, at its canonical end
  std::vector<std::uint8_t> required_;                // bits as in TMesh::edges; empty: none
  std::set<std::pair<int, int>> missing_;
  std::set<int> crossed_;  // vertices with crossings
  int crossings_ = 0;
};

/// Extraordinary points (numbers) whose zone a path breaks: within `rings` h of the point, measured in the faces at it by the larger coordinate,
/// the mesh must be the uniform h lattice, and the path has a unit edge off that lattice there. Three rings are what nestedness needs.
std::vector<int> broken_zones(const TMesh& mesh, const std::vector<Ray>& path, int rings);

/// Mid lines of the twelve elements of the two rings at an extraordinary point; with them the zone is whole again for h / 2.
std::vector<std::vector<Ray>> two_ring_cuts(const TMesh& mesh, int point);

/// Halves h of every point whose zone one of the paths breaks, and goes on with the lines that this adds until all zones are whole.
/// Returns the number of halvings.
int restore_zones(ExtendedMesh& extended, std::vector<std::vector<Ray>> paths, int rings);

}  // namespace tanktread::spline
