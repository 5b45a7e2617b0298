#pragma once
// Which rank does which elements and control points. METIS is used here and nowhere else.

#include <span>
#include <vector>

#include "spline/space.hpp"

namespace tanktread::surface {

/// One owner (0 .. parts - 1) for every element and every control point.
struct Partition {
  int parts = 1;
  std::vector<int> element_owner, point_owner;
};

/// Connected parts of nearly equal cost: METIS on the graph of elements that share control points (heavier edges for more of them). A point
/// belongs to the part that owns most of the elements around it, as long as that keeps the numbers of points balanced too.
/// Deterministic; `cost` an element (empty: 1 each). Throws UserError when there are more parts than elements.
Partition partition(const spline::Space& space, int parts, std::span<const double> cost = {});

/// The same where only some of the points have work, as the fundamental ones of a symmetric surface: those are what is balanced, and the others
/// belong to nobody (-1).
Partition partition_of_points(const spline::Space& space, int parts, std::span<const int> points);

/// What one rank does: its own points, and all elements that touch them; both ascending.
struct Share {
  std::vector<int> points, elements;
};
Share share(const spline::Space& space, const Partition& partition, int rank);

}  // namespace tanktread::surface
