#include "record/files/nodes.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <span>
#include <utility>

#include <Eigen/Geometry>

#include "base/groups.hpp"
#include "base/threads.hpp"
#include "spline/bernstein.hpp"
#include "spline/point_search.hpp"
#include "surface/patch.hpp"
#include "surface/three_sums.hpp"

namespace tanktread::output {

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

std::vector<int> surfaces(const spline::Space& space) {
  Groups joined(static_cast<std::size_t>(space.n_points));
  for (const auto& element : space.elements)
    for (const int point : element.points) joined.join(point, element.points.front());
  std::vector<int> all;
  for (const auto& element : space.elements) all.push_back(joined.of(element.points.front()));
  return all;
}

LagrangeMesh lagrange_mesh(const spline::Space& space, const Net& net, const std::vector<int>& surface_of_element) {
  LagrangeMesh mesh;
  struct Place {
    spline::Site site;
    int surface;
    Vec3 x;
  };
  std::vector<Place> places;
  std::map<int, std::vector<Vec3>> of_surface;
  double size = 0;
  mesh.offsets.push_back(0);
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e) {
    const int p = space.elements[e].degree, surface = surface_of_element.empty() ? 0 : surface_of_element[e];
    const surface::ElementPoints points(space, net, e);
    for (const auto& [i, j] : node_order(p)) {
      const spline::Site site{e, double(i) / p, double(j) / p};
      places.push_back({site, surface, surface::position(points.patch(), site.s, site.t)});
      of_surface[surface].push_back(places.back().x);
      size = std::max(size, (places.back().x - places.front().x).norm());
    }
    mesh.offsets.push_back(static_cast<std::int64_t>(places.size()));
  }
  std::map<int, spline::PointSearch> search;
  for (auto& [surface, points] : of_surface) search.emplace(surface, spline::PointSearch(std::move(points), 1e-9 * size));
  std::map<std::pair<int, int>, std::int64_t> nodes;  // number of each node by its surface and its index in `search`
  for (const Place& place : places) {
    const auto [node, first] = nodes.emplace(std::pair(place.surface, search.at(place.surface).at(place.x)), std::ssize(mesh.sites));
    if (first) mesh.sites.push_back(place.site);
    mesh.connectivity.push_back(node->second);
  }
  return mesh;
}

namespace {

constexpr int n_parts = 6;  // number of vectors in a jet: the position and five derivatives

/// Returns the matrix that maps the Bezier points of an element to the jets (position and derivatives) at the nodes of its cell. An element of degree
/// p has n = (p + 1)^2 Bezier points and n nodes. Shape (n, 6, n): Bezier point, component of the jet, node.
std::vector<double> jet_table(int p) {
  constexpr std::array<std::array<int, 2>, n_parts> derivatives{{{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}};
  const auto order = node_order(p);
  std::vector<double> table;
  for (int b = 0; b < (p + 1) * (p + 1); ++b)
    for (const auto& [along_s, along_t] : derivatives)
      for (const auto& node : order) {
        double s[3][spline::most_polynomial_degree + 1], t[3][spline::most_polynomial_degree + 1];
        spline::bernstein(p, double(node[0]) / p, s[0], s[1], s[2]);
        spline::bernstein(p, double(node[1]) / p, t[0], t[1], t[2]);
        table.push_back(s[along_s][b % (p + 1)] * t[along_t][b / (p + 1)]);
      }
  return table;
}

/// Returns normals at the nodes of an element, not normalised. `jets`: position and derivatives at the nodes.
std::vector<Vec3> cell_normals(const surface::Patch& patch, std::span<const surface::Jet> jets) {
  constexpr double degenerate = 1e-6;  // a node is a pole if the cross product of x_,s and x_,t is below this fraction of max|x_,s| max|x_,t|
  constexpr double inset = 1e-4;       // normals at a pole are evaluated at a point moved by this fraction of the way to the element's middle
  double longest_1 = 0, longest_2 = 0;
  std::vector<Vec3> normals;
  for (const surface::Jet& here : jets) {
    longest_1 = std::max(longest_1, here.s.norm());
    longest_2 = std::max(longest_2, here.t.norm());
    normals.push_back(here.s.cross(here.t));
  }
  for (std::size_t k = 0; k < normals.size(); ++k)
    if (normals[k].norm() < degenerate * longest_1 * longest_2) {
      const auto node = node_order(patch.degree)[k];
      const double s = double(node[0]) / patch.degree, t = double(node[1]) / patch.degree;
      const surface::Jet inside = surface::jet(patch, s + inset * (0.5 - s), t + inset * (0.5 - t));
      normals[k] = inside.s.cross(inside.t);
    }
  return normals;
}

}  // namespace

Nodes::Nodes(surface::BezierMap map, LagrangeMesh mesh) : map_(std::move(map)), mesh_(std::move(mesh)) {
  for (const surface::DegreeGroup& group : map_.groups()) {
    const std::vector<double>& table = tables_[group.degree] = jet_table(group.degree);
    const auto n = static_cast<std::ptrdiff_t>((group.degree + 1) * (group.degree + 1));
    std::vector<double>& values = values_[group.degree];
    for (auto row = table.begin(); row != table.end(); row += n_parts * n) values.insert(values.end(), row, row + n);
  }
}

/// Computes the jets (position and derivatives) at the nodes of the Lagrange cell of an element. Returns the element's Bezier points.
Nodes::Points Nodes::jets(int element, const Net& net, std::vector<surface::Jet>& jets) const {
  const int n = map_.n_bezier(element);
  Points points;
  double sums[n_parts * std::tuple_size_v<Points>];
  map_.points(element, net, points.data());
  surface::three_sums(n_parts * n, n, tables_.at(map_.degree(element)).data(), points.data(), sums);
  const auto part = [&](int derivative, int k) {
    const double* at = sums + n * derivative + k;
    return Vec3(at[0], at[n_parts * n], at[2 * n_parts * n]);
  };
  jets.clear(), jets.reserve(static_cast<std::size_t>(n));
  for (int k = 0; k < n; ++k) jets.push_back({part(0, k), part(1, k), part(2, k), part(3, k), part(4, k), part(5, k)});
  return points;
}

/// Returns the numbers of the nodes of an element's cell.
std::span<const std::int64_t> Nodes::cell(int element) const {
  const auto first = static_cast<std::size_t>(mesh_.offsets[element]), last = static_cast<std::size_t>(mesh_.offsets[element + 1]);
  return std::span(mesh_.connectivity).subspan(first, last - first);
}

Net Nodes::values(const Net& control_values) const {
  Net result(mesh_.sites.size(), 3);
  Points points, sums;
  for (int e = map_.n_elements(); e-- > 0;) {  // in reverse order: a node of several elements keeps the value from the first one
    const int n = map_.n_bezier(e);
    map_.points(e, control_values, points.data());
    surface::three_sums(n, n, values_.at(map_.degree(e)).data(), points.data(), sums.data());
    for (int k = 0; k < n; ++k) result.row(cell(e)[k]) << sums[k], sums[n + k], sums[2 * n + k];
  }
  return result;
}

Net Nodes::normals(const Net& net) const {
  Net sum = Net::Zero(static_cast<Eigen::Index>(mesh_.sites.size()), 3);
  const int at_a_time = std::min(256, map_.n_elements());
  std::vector<std::vector<Vec3>> all(at_a_time);
  for (int end = map_.n_elements(); end > 0; end -= at_a_time) {
    const int some = std::min(at_a_time, end);
    each_block(some, 16, [&](int first, int last) {
      std::vector<surface::Jet> here;
      for (int k = first; k < last; ++k) {
        const Points points = jets(end - 1 - k, net, here);
        all[k] = cell_normals(surface::Patch{map_.degree(end - 1 - k), points.data()}, here);
      }
    });
    for (int k = 0; k < some; ++k)
      for (std::size_t j = 0; j < all[k].size(); ++j) sum.row(cell(end - 1 - k)[j]) += all[k][j].normalized();
  }
  sum.rowwise().normalize();
  return sum;
}

}  // namespace tanktread::output
