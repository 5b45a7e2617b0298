#pragma once
// Local refinement of a T-mesh whose splines stay linearly independent and contain the old ones; taking cuts back; and the symmetries of the mesh
// that both keep.

#include <optional>
#include <span>

#include "spline/space.hpp"
#include "spline/t_mesh.hpp"

namespace tanktread::spline {

/// A map of the vertices onto themselves that keeps neighbours: slot k at v goes to slot turn[v] + k at vertex[v], or to turn[v] - k when the map is
/// mirrored (counted modulo the valence).
struct LatticeMap {
  std::vector<int> vertex;
  std::vector<std::uint8_t> turn;
  bool mirrored = false;
};

Ray image(const Lattice& lattice, const LatticeMap& map, Ray ray);

/// Each ray of a path.
std::vector<Ray> image(const Lattice& lattice, const LatticeMap& map, const std::vector<Ray>& path);

/// The element of a tiling that the map takes another one to, and whether s and t change places. The tiling has to have the symmetry.
struct TileImage {
  int tile;
  bool exchanged;
};
TileImage image(const Lattice& lattice, const LatticeMap& map, const Tiling& tiling, int tile);

/// The only map that takes one ray to another, mirrored or not; none where the lattice has no such symmetry.
std::optional<LatticeMap> lattice_map(const Lattice& lattice, Ray from, Ray to, bool mirrored);

/// The map that takes the T-mesh elements under Bezier element e to that under element[e], for all of them; none where there is none.
std::optional<LatticeMap> lattice_map(const TMesh& mesh, const Space& space, std::span<const int> element, bool mirrored);

/// Cut an element of elements(mesh) in halves: across s (a line of constant s), across t, or both.
struct Mark {
  int element;
  bool s = true, t = true;
};

/// Which rules the repair keeps. All of them are needed for nested spaces; they are switches so that tests can show it.
struct RepairRules {
  bool no_overlaps = true;        ///< no vertex between two T-junctions that point at each other
  bool nested_extensions = true;  ///< the extended mesh contains the one before
  int rings = 3;                  ///< uniform rings at extraordinary points
  std::vector<LatticeMap> images = {};  ///< symmetries of the mesh, a group without the identity: what is cut is cut in all of them
};

struct Refinement {
  TMesh mesh;
  int refused = 0;   ///< cuts that the lattice is too coarse for
  int repairs = 0;   ///< bays added to keep the rules
  int halvings = 0;  ///< extraordinary points whose rings were halved
};

/// Cuts the marked elements, then adds the first bay of one T-junction after the other, the least harmful of those involved, until no extensions
/// cross, none that was there is missing, and none overlap; at an extraordinary point whose rings are entered, cuts the inner two rings.
/// Only edges are added. Depends on the set of marks, not on their order. A mesh with the symmetry of the rules' images keeps it: marks and repairs
/// stand for all their images.
///
/// Source: Scott, Li, Sederberg, Hughes 2012, with a local instead of a global choice, the third rule, and extraordinary points.
Refinement refine(const TMesh& mesh, const std::vector<Mark>& marks, const RepairRules& rules = {});

class ExtendedMesh;
/// The repair alone. Returns the numbers of bays and of halvings.
std::pair<int, int> repair(ExtendedMesh& extended, const RepairRules& rules);

struct Coarsening {
  TMesh mesh;
  int bays = 0;       ///< taken out
  int doublings = 0;  ///< extraordinary points whose rings went back to twice the spacing
  int repairs = 0;    ///< bays put in again to keep the mesh analysis-suitable
};

/// How often an element of elements(mesh) may double its width (s) and height (t).
struct Merge {
  int element;
  int s = 1, t = 1;
};

/// Takes out the lines that both sides allow to go: those that are not on the grid of the smaller of the two allowed widths. Lines of the base
/// mesh stay, and so do the rings at an extraordinary point, which go as a whole.
///
/// All lines that may go are taken out together and the mesh is then repaired (one at a time, each would be held by its neighbours). The splines
/// of the result need not be contained in the old ones, so fields go over by Projection. Under the rules' images an element may grow as far as all
/// its images may, and a line goes with all of its own or not at all.
Coarsening coarsen(const TMesh& mesh, const std::vector<Merge>& merges, const RepairRules& rules = {});

/// The same for a given set of unit edges (bits as in TMesh::edges): an edge goes if its whole bay may go.
Coarsening take_out(const TMesh& mesh, const std::vector<std::uint8_t>& removable, const RepairRules& rules = {});

}  // namespace tanktread::spline
