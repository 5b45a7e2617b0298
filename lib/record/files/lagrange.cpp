#include "record/files/lagrange.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "surface/patch.hpp"

namespace tanktread::output {
namespace {

/// For each place, the first of all places that coincide with it. They are swept along a direction that no symmetry of a mesh has, so
/// that few come near one another.
std::vector<std::size_t> first_of_equals(const std::vector<Vec3>& places) {
  const Vec3 direction(0.8137, 0.4691, 0.3433);
  double size = 0;
  std::vector<double> along;
  for (const Vec3& x : places) {
    along.push_back(direction.dot(x));
    size = std::max(size, (x - places.front()).norm());
  }
  const double tolerance = 1e-9 * size;
  std::vector<std::size_t> order(places.size()), first(places.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, {}, [&](std::size_t k) { return along[k]; });
  std::iota(first.begin(), first.end(), 0);
  for (std::size_t a = 0; a < order.size(); ++a)
    for (std::size_t b = a; b-- > 0 && along[order[a]] - along[order[b]] <= tolerance;)
      if ((places[order[a]] - places[order[b]]).norm() <= tolerance) {
        const std::size_t low = std::min(first[order[a]], first[order[b]]);
        first[order[a]] = first[order[b]] = low;
      }
  for (std::size_t& k : first)
    while (first[k] != k) k = first[k];
  return first;
}

}  // namespace

std::vector<std::array<int, 2>> node_order(int p) {
  std::vector<std::array<int, 2>> nodes{{0, 0}, {p, 0}, {p, p}, {0, p}};
  for (int i = 1; i < p; ++i) nodes.push_back({i, 0});
  for (int j = 1; j < p; ++j) nodes.push_back({p, j});
  for (int i = 1; i < p; ++i) nodes.push_back({i, p});
  for (int j = 1; j < p; ++j) nodes.push_back({0, j});
  for (int j = 1; j < p; ++j)
    for (int i = 1; i < p; ++i) nodes.push_back({i, j});
  return nodes;
}

LagrangeMesh lagrange_mesh(const spline::Space& space, const Net& net) {
  LagrangeMesh mesh;
  std::vector<Vec3> places;
  std::vector<spline::Site> sites;
  mesh.offsets.push_back(0);
  for (std::size_t e = 0; e < space.elements.size(); ++e) {
    const int p = space.elements[e].degree;
    const surface::ElementPoints points(space, net, static_cast<int>(e));
    for (const auto& [i, j] : node_order(p)) {
      sites.push_back({static_cast<int>(e), double(i) / p, double(j) / p});
      places.push_back(surface::place(points.patch(), sites.back().s, sites.back().t));
    }
    mesh.offsets.push_back(static_cast<std::int64_t>(places.size()));
  }
  const std::vector<std::size_t> first = first_of_equals(places);
  std::vector<std::int64_t> number(places.size());
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (first[k] == k) {
      number[k] = static_cast<std::int64_t>(mesh.sites.size());
      mesh.sites.push_back(sites[k]);
    }
    mesh.connectivity.push_back(number[first[k]]);
  }
  return mesh;
}

}  // namespace tanktread::output
