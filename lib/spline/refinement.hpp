#pragma once
// Local refinement of a T-mesh whose splines stay linearly independent and contain the old ones.

#include "spline/lattice_map.hpp"
#include "spline/t_mesh.hpp"

namespace tanktread::spline {

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

}  // namespace tanktread::spline
