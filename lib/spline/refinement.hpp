#pragma once
// Local refinement of a T-mesh such that the splines stay linearly independent and the new spline space contains the old one; coarsening; the
// symmetries of the mesh that refinement and coarsening keep.

#include <optional>
#include <span>

#include "spline/space.hpp"
#include "spline/t_mesh.hpp"

namespace tanktread::spline {

/// A symmetry of the lattice: maps vertices to vertices and keeps neighbours. Direction (slot) k at vertex v is mapped to slot turn[v] + k at
/// vertex[v], or to turn[v] - k if the map is mirrored (modulo the valence).
struct LatticeMap {
  std::vector<int> vertex;
  std::vector<std::uint8_t> turn;
  bool mirrored = false;
};

Ray image(const Lattice& lattice, const LatticeMap& map, Ray ray);

/// Returns the image, under the symmetry `map`, of each ray of a path.
std::vector<Ray> image(const Lattice& lattice, const LatticeMap& map, const std::vector<Ray>& path);

/// Image of a mesh element under a symmetry of the mesh: index of the image element, and whether the symmetry exchanges s and t.
struct TileImage {
  int tile;
  bool exchanged;
};
TileImage image(const Lattice& lattice, const LatticeMap& map, const Tiling& tiling, int tile);

/// Returns the unique symmetry of the lattice that maps the ray `from` to the ray `to`: a reflection if `mirrored`, otherwise a rotation; nothing if
/// there is none.
std::optional<LatticeMap> lattice_map(const Lattice& lattice, Ray from, Ray to, bool mirrored);

/// Returns the map of the lattice that agrees with a map of Bezier elements; nothing if there is no such map. `element`: for every Bezier element e,
/// its image. The result maps the T-mesh element that contains e to the T-mesh element that contains element[e].
std::optional<LatticeMap> lattice_map(const TMesh& mesh, const Space& space, std::span<const int> element, bool mirrored);

/// Request to bisect an element of elements(mesh): across s (by a line of constant s), across t, or both.
struct Mark {
  int element;
  bool s = true, t = true;
};

/// Rules for the mesh, which the repair after a refinement enforces. The spline spaces are nested only if all rules hold. Tests switch off one rule
/// at a time to show this.
struct RepairRules {
  bool no_overlaps = true;        ///< no lattice vertex is on the face extensions of two T-junctions that point at each other
  bool nested_extensions = true;  ///< the extended mesh (T-mesh with extensions) still contains all edges that it had before the refinement
  int rings = 3;                  ///< number of rings of equal elements required around each extraordinary point
  std::vector<LatticeMap> images = {};  ///< symmetries of the mesh to keep, a group without the identity; bisections are applied to all images
};

struct Refinement {
  TMesh mesh;
  int refused = 0;   ///< number of bisections not done because the lattice is too coarse
  int halvings = 0;  ///< number of times that the spacing around an extraordinary point was halved
};

/// Bisects the marked elements and repairs the mesh. The repair adds bays (parts of a line between two successive perpendicular edges) one by one
/// until three rules hold: no extensions of T-junctions cross, every extension that existed before still exists, and no extensions overlap. Each bay
/// extends one of the T-junctions that violate a rule. For crossing or missing extensions, this is the T-junction for which the fewest violations
/// remain. For overlapping extensions, it is the T-junction with the shorter bay. If a bisection enters the three uniform rings of elements around an
/// extraordinary point, all elements of the two inner rings are bisected. Edges are only added. The result depends on the set of marks but not on
/// their order. If the mesh has the symmetries of `rules.images`, it keeps them, because marks and repairs are applied to all images.
///
/// Source: Scott, Li, Sederberg, Hughes 2012, with a local instead of a global choice of T-junctions, and with additional rules on overlaps and
/// extraordinary points.
Refinement refine(const TMesh& mesh, const std::vector<Mark>& marks, const RepairRules& rules = {});

class ExtendedMesh;
/// Adds edges until the mesh satisfies the rules, without bisecting elements. Returns the number of times that the spacing around an extraordinary
/// point was halved.
int repair(ExtendedMesh& extended, const RepairRules& rules);

/// Permission for an element of elements(mesh) to grow: `s` and `t` are the numbers of times that its width and its height may be doubled.
struct Merge {
  int element;
  int s = 1, t = 1;
};

/// Removes mesh lines between elements that may grow (Merge). Each of the two elements at a line may grow to a largest width; let w be the smaller of
/// the two widths. The line is removed if its coordinate is not a multiple of w. Lines of the initial mesh stay. The uniform rings of elements around
/// an extraordinary point are coarsened only as a whole.
///
/// All these lines are removed together, and the mesh is repaired afterwards. If they were removed one by one, many lines would have to stay because
/// of T-junctions on neighbouring lines. The new spline space need not be contained in the old one, so fields are transferred by projection(). With
/// `rules.images`, an element grows only as far as all of its images may grow, and a line is removed only together with all of its images.
TMesh coarsen(const TMesh& mesh, const std::vector<Merge>& merges, const RepairRules& rules = {});

/// Coarsens a mesh by removing unit edges of the set `removable` (bits as in TMesh::edges). All edges of a line between two successive perpendicular
/// edges are removed together, and only if all of them are in the set.
TMesh take_out(const TMesh& mesh, const std::vector<std::uint8_t>& removable, const RepairRules& rules = {});

}  // namespace tanktread::spline
