#pragma once
// Groups of elements of equal degree for the vectorised integrals of `integrals_kernel.hpp`: each lane of a SIMD register holds one element.

#include <algorithm>
#include <iterator>
#include <span>
#include <vector>

#include "base/threads.hpp"
#include "surface/bezier_points.hpp"
#include "surface/integrals_kernel.hpp"

namespace tanktread::surface {

/// Calls compute(degree, group, part) for all elements, in groups of equal degree, on all threads, and then add(group, part) in the order of the
/// groups. A group has at most as many elements as a SIMD register has lanes.
template <class Part, class Compute, class Add>
void each_group(const BezierMap& map, std::span<const int> elements, const Compute& compute, const Add& add) {
  constexpr std::size_t at_a_time = 256;  // number of groups whose parts are in memory
  const std::size_t lanes = pack_lanes();
  std::vector<int> alike;
  std::vector<Part> parts;
  for (const DegreeGroup& of_degree : map.groups()) {
    alike.clear();
    std::ranges::copy_if(elements, std::back_inserter(alike), [&](int e) { return map.degree(e) == of_degree.degree; });
    const std::size_t groups = (alike.size() + lanes - 1) / lanes;
    const auto group = [&](std::size_t k) { return std::span<const int>(alike).subspan(k * lanes, std::min(lanes, alike.size() - k * lanes)); };
    for (std::size_t first = 0; first < groups; first += at_a_time) {
      const std::size_t some = std::min(at_a_time, groups - first);
      parts.resize(std::max(parts.size(), some));
      each_item(some, [&](std::size_t k) { compute(of_degree.degree, group(first + k), parts[k]); });
      for (std::size_t k = 0; k < some; ++k) add(group(first + k), parts[k]);
    }
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
