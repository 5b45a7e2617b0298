#include "surface/partition.hpp"

#include <metis.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/errors.hpp"

namespace tanktread::surface {
namespace {

/// Neighbours of every element, stored as compressed sparse rows, weighted by the number of common control points.
struct Graph {
  std::vector<idx_t> start, neighbour, weight;
};

std::vector<std::vector<int>> elements_of_points(const spline::Space& space) {
  std::vector<std::vector<int>> result(space.n_points);
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e)
    for (const int a : space.elements[e].points) result[a].push_back(e);
  return result;
}

Graph common_points(const spline::Space& space, const std::vector<std::vector<int>>& elements_of) {
  Graph graph;
  graph.start.push_back(0);
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e) {
    std::map<int, idx_t> common;
    for (const int a : space.elements[e].points)
      for (const int f : elements_of[a])
        if (f != e) ++common[f];
    for (const auto& [f, points] : common) {
      graph.neighbour.push_back(f);
      graph.weight.push_back(points);
    }
    graph.start.push_back(static_cast<idx_t>(graph.neighbour.size()));
  }
  return graph;
}

/// Returns the costs scaled to positive integers, which METIS requires.
std::vector<idx_t> scaled(std::span<const double> cost) {
  const double largest = *std::max_element(cost.begin(), cost.end());
  std::vector<idx_t> result;
  for (const double c : cost) result.push_back(std::max<idx_t>(1, std::lround(1000 * c / largest)));
  return result;
}

std::vector<int> element_owners(Graph graph, int parts, std::span<const double> cost) {
  idx_t n = static_cast<idx_t>(graph.start.size()) - 1, constraints = 1, k = parts, cut = 0;
  std::vector<idx_t> weights = scaled(cost), owner(n);
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  options[METIS_OPTION_UFACTOR] = 10;  // allows the costs of the parts to differ from the mean by one per cent
  const auto method = parts <= 8 ? METIS_PartGraphRecursive : METIS_PartGraphKway;
  const int status = method(&n, &constraints, graph.start.data(), graph.neighbour.data(), weights.data(), nullptr, graph.weight.data(), &k,
                            nullptr, nullptr, options, &cut, owner.data());
  if (status != METIS_OK) throw std::runtime_error("METIS could not partition the surface (status " + std::to_string(status) + ")");
  return {owner.begin(), owner.end()};
}

/// Assigns each of the control points `shared` to the part that owns most of the elements around the point, beginning with the points with the
/// largest majority. If this part already has its equal share of the points, the point goes to the adjacent part with the fewest points.
std::vector<int> point_owners(const std::vector<std::vector<int>>& elements_of, const std::vector<int>& element_owner, int parts,
                              std::span<const int> shared) {
  const int n = static_cast<int>(shared.size());
  std::vector<std::map<int, int>> votes(elements_of.size());
  std::vector<int> order(shared.begin(), shared.end()), lead(elements_of.size()), points(parts, 0), owner(elements_of.size(), -1);
  for (const int a : shared) {
    for (const int e : elements_of[a]) ++votes[a][element_owner[e]];
    int most = 0;
    for (const auto& [part, count] : votes[a]) most = std::max(most, count);
    lead[a] = 2 * most - static_cast<int>(elements_of[a].size());
  }
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return lead[a] > lead[b]; });
  for (const int a : order) {
    using Vote = std::pair<const int, int>;
    const auto majority =
        std::max_element(votes[a].begin(), votes[a].end(), [](const Vote& x, const Vote& y) { return x.second < y.second; });
    const auto fewest =
        std::min_element(votes[a].begin(), votes[a].end(), [&](const Vote& x, const Vote& y) { return points[x.first] < points[y.first]; });
    owner[a] = points[majority->first] * parts < n ? majority->first : fewest->first;
    ++points[owner[a]];
  }
  return owner;
}

}  // namespace

Partition partition_of_points(const spline::Space& space, int parts, std::span<const int> points) {
  const std::size_t n = space.elements.size();
  if (static_cast<std::size_t>(parts) > n)
    throw UserError("A surface of " + std::to_string(n) + " elements cannot be shared among " + std::to_string(parts) +
                    " ranks; use at most one rank per element.");
  const std::vector<std::vector<int>> elements_of = elements_of_points(space);
  std::vector<int> owner(n, 0);
  if (parts > 1) {
    std::vector<char> wanted(space.n_points, 0);
    for (const int a : points) wanted[a] = 1;
    std::vector<double> cost;
    for (const auto& e : space.elements) {
      const auto count = std::ranges::count_if(e.points, [&](int a) { return wanted[a] != 0; });
      cost.push_back(static_cast<double>(count) / static_cast<double>(e.points.size()));
    }
    owner = element_owners(common_points(space, elements_of), parts, cost);
  }
  return {parts, owner, point_owners(elements_of, owner, parts, points)};
}

Share share(const spline::Space& space, const Partition& partition, int rank) {
  Share result;
  for (int a = 0; a < space.n_points; ++a)
    if (partition.point_owner[a] == rank) result.points.push_back(a);
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e) {
    const auto& points = space.elements[e].points;
    if (std::any_of(points.begin(), points.end(), [&](int a) { return partition.point_owner[a] == rank; })) result.elements.push_back(e);
  }
  return result;
}

}  // namespace tanktread::surface
