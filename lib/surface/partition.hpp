#pragma once
// Distribution of elements and control points over ranks. METIS is used only here.

#include <span>
#include <vector>

#include "spline/space.hpp"

namespace tanktread::surface {

/// The owner (part 0 .. parts - 1) of every element and of every control point.
struct Partition {
  int parts = 1;
  std::vector<int> element_owner, point_owner;
};

/// Divides the elements by METIS into parts of nearly equal cost that share few control points. `points`: control points that cause work, for example
/// the fundamental points of a symmetric surface. Other control points have no owner (-1). The cost of an element is the fraction of its control
/// points that cause work. Elements that share control points are neighbours in the graph, and the number of shared points is the weight of the
/// graph's edge. A control point belongs to the part that owns most of the elements around it, as long as all parts own about equally many points.
/// The result is deterministic. Throws UserError if there are more parts than elements.
Partition partition_of_points(const spline::Space& space, int parts, std::span<const int> points);

/// Work of one rank: the indices of the control points that the rank owns, and of all elements with at least one of these points; both ascending.
struct Share {
  std::vector<int> points, elements;
};
Share share(const spline::Space& space, const Partition& partition, int rank);

}  // namespace tanktread::surface
