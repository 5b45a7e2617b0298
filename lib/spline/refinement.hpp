#pragma once
// Local refinement of a T-mesh such that its splines stay linearly independent and contain the old ones, coarsening, and the symmetries of the mesh
// that both keep.

#include <optional>
#include <span>

#include "spline/space.hpp"
#include "spline/t_mesh.hpp"

namespace tanktread::spline {

/// A symmetry of the lattice: maps vertices to vertices and keeps neighbours. Slot k at v is mapped to slot turn[v] + k at vertex[v], or to turn[v] -
/// k if the map is mirrored (modulo the valence).
struct LatticeMap {
  std::vector<int> vertex;
  std::vector<std::uint8_t> turn;
  bool mirrored = false;
};

Ray image(const Lattice& lattice, const LatticeMap& map, Ray ray);

/// Returns the image of each ray of a path.
std::vector<Ray> image(const Lattice& lattice, const LatticeMap& map, const std::vector<Ray>& path);

/// Image of an element of a tiling, and whether the map exchanges s and t. The tiling must have the symmetry.
struct TileImage {
  int tile;
  bool exchanged;
};
TileImage image(const Lattice& lattice, const LatticeMap& map, const Tiling& tiling, int tile);

/// Returns the unique map, mirrored or not, that maps one ray to another; nothing if the lattice does not have this symmetry.
std::optional<LatticeMap> lattice_map(const Lattice& lattice, Ray from, Ray to, bool mirrored);

/// Returns the map that, for every Bezier element e, maps the T-mesh element that contains e to the T-mesh element that contains element[e]; nothing
/// if there is no such map.
std::optional<LatticeMap> lattice_map(const TMesh& mesh, const Space& space, std::span<const int> element, bool mirrored);

/// Requests to bisect an element of elements(mesh): across s (by a line of constant s), across t, or both.
struct Mark {
  int element;
  bool s = true, t = true;
};

/// Rules that the repair enforces. All are needed for nested spaces. Tests switch them off to show this.
struct RepairRules {
  bool no_overlaps = true;        ///< no vertex is between two T-junctions that point at each other
  bool nested_extensions = true;  ///< the extended mesh contains the extended mesh before the refinement
  int rings = 3;                  ///< number of uniform rings at extraordinary points
  std::vector<LatticeMap> images = {};  ///< symmetries of the mesh to keep, a group without the identity; each cut is applied to all images
};

struct Refinement {
  TMesh mesh;
  int refused = 0;   ///< number of cuts for which the lattice is too coarse
  int repairs = 0;   ///< number of bays added to satisfy the rules
  int halvings = 0;  ///< number of times that the rings of an extraordinary point were halved
};

/// Bisects the marked elements and repairs the mesh. The repair adds one bay after the other, where a bay is the part of a line between two
/// successive perpendicular edges, until no extensions cross, none of the earlier extensions is missing, and none overlap. It adds the first bay of
/// the extension of one of the T-junctions involved, the one that causes the fewest new violations. If a cut enters the rings of an extraordinary
/// point, the two inner rings are cut. Edges are only added. The result depends on the set of marks but not on their order. If the mesh has the
/// symmetries of `rules.images`, it keeps them, because marks and repairs are applied to all images.
///
/// Source: Scott, Li, Sederberg, Hughes 2012, with a local instead of a global choice, the third rule, and extraordinary points.
Refinement refine(const TMesh& mesh, const std::vector<Mark>& marks, const RepairRules& rules = {});

class ExtendedMesh;
/// Repairs the mesh without bisecting elements. Returns the number of added bays and the number of halvings.
std::pair<int, int> repair(ExtendedMesh& extended, const RepairRules& rules);

/// Result of `coarsen`. A bay is the part of a mesh line between two successive perpendicular edges.
struct Coarsening {
  TMesh mesh;
  int bays = 0;       ///< number of bays removed
  int doublings = 0;  ///< number of times that the spacing of the rings of an extraordinary point was doubled
  int repairs = 0;    ///< number of bays inserted after the removal to make the mesh analysis-suitable
};

/// Permission for an element of elements(mesh) to grow: `s` and `t` are the numbers of times that its width and its height may be doubled.
struct Merge {
  int element;
  int s = 1, t = 1;
};

/// Removes the lines that the elements on both sides permit to remove: lines that are not on the grid of the smaller of the two permitted widths.
/// Lines of the base mesh stay. The rings at an extraordinary point are only removed as a whole.
///
/// All these lines are removed together, and the mesh is then repaired, because single lines would be kept by their neighbours. The new spline space
/// need not be contained in the old one, so fields are transferred by Projection. With `rules.images`, an element may grow as far as all of its
/// images may, and a line is removed with all of its images or not at all.
Coarsening coarsen(const TMesh& mesh, const std::vector<Merge>& merges, const RepairRules& rules = {});

/// Coarsens a mesh by removing edges of a given set of unit edges (bits as in TMesh::edges). An edge is removed if its whole bay may be removed.
Coarsening take_out(const TMesh& mesh, const std::vector<std::uint8_t>& removable, const RepairRules& rules = {});

}  // namespace tanktread::spline
