#pragma once
// Taking cuts back.

#include "base/types.hpp"
#include "spline/extraction.hpp"
#include "spline/refinement.hpp"

namespace tanktread::spline {

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
