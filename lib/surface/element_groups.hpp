#pragma once
// Groups of elements of equal degree for the vectorised integrals of `integrals_kernel.hpp`: each lane of a SIMD register holds one element.

#include <algorithm>
#include <iterator>
#include <span>
#include <vector>

#include "surface/bezier_points.hpp"
#include "surface/integrals_kernel.hpp"

namespace tanktread::surface {

/// Calls use(degree, group) for all elements, in groups of equal degree. A group has at most as many elements as a SIMD register has lanes.
template <class Use>
void each_group(const BezierMap& map, std::span<const int> elements, Use use) {
  const std::size_t lanes = pack_lanes();
  std::vector<int> alike;
  for (const DegreeGroup& group : map.groups()) {
    alike.clear();
    std::ranges::copy_if(elements, std::back_inserter(alike), [&](int e) { return map.degree(e) == group.degree; });
    for (std::size_t first = 0; first < alike.size(); first += lanes)
      use(group.degree, std::span<const int>(alike).subspan(first, std::min(lanes, alike.size() - first)));
  }
}

/// Returns the Bezier points of a group, one element per lane of a SIMD register. If the group has fewer elements than lanes, its last element is
/// repeated.
inline kernel::Lanes points_of(const BezierMap& map, const Net& net, std::span<const int> group) {
  const std::size_t lanes = pack_lanes();
  kernel::Lanes points;
  double one[3 * kernel::most_bezier];
  for (std::size_t l = 0; l < lanes; ++l) {
    if (l < group.size()) map.points(group[l], net, one);
    for (int k = 0; k < 3 * map.n_bezier(group[0]); ++k) points.value[k * lanes + l] = one[k];
  }
  return points;
}

}  // namespace tanktread::surface
