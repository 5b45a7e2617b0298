#include "output/nodes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "surface/three_sums.hpp"

namespace tanktread::output {
namespace {

constexpr int most = (spline::max_degree + 1) * (spline::max_degree + 1);

/// A field given by Bezier points (3, n) at the n nodes of a cell, (3, n) again.
void at_nodes(int n, const std::vector<double>& table, const double* points, double* values) {
  surface::three_sums(n, n, table.data(), [&](int b, int c) { return points[c * n + b]; }, values);
}

/// The normal of an element at node (i, j), moved by `inset` of the way to the middle.
Vec3 normal_inside(const surface::Patch& patch, const std::array<int, 2>& node, double inset) {
  const double s = double(node[0]) / patch.degree, t = double(node[1]) / patch.degree;
  const surface::Jet at = surface::jet(patch, s + inset * (0.5 - s), t + inset * (0.5 - t));
  return at.s.cross(at.t);
}

}  // namespace

Nodes::Table Nodes::table(int degree) {
  Table result;
  result.order = node_order(degree);
  const int p = degree, n = (p + 1) * (p + 1);
  for (auto* part : {&result.value, &result.s, &result.t, &result.ss, &result.st, &result.tt}) part->resize(static_cast<std::size_t>(n * n));
  for (int k = 0; k < n; ++k) {
    double a[3][spline::max_degree + 1], b[3][spline::max_degree + 1];  // along s, along t: value and two derivatives
    spline::bernstein(p, double(result.order[static_cast<std::size_t>(k)][0]) / p, a[0], a[1], a[2]);
    spline::bernstein(p, double(result.order[static_cast<std::size_t>(k)][1]) / p, b[0], b[1], b[2]);
    for (int j = 0; j <= p; ++j)
      for (int i = 0; i <= p; ++i) {
        const auto at = static_cast<std::size_t>((j * (p + 1) + i) * n + k);
        result.value[at] = a[0][i] * b[0][j];
        result.s[at] = a[1][i] * b[0][j];
        result.t[at] = a[0][i] * b[1][j];
        result.ss[at] = a[2][i] * b[0][j];
        result.st[at] = a[1][i] * b[1][j];
        result.tt[at] = a[0][i] * b[2][j];
      }
  }
  return result;
}

Nodes::Nodes(surface::BezierMap map, LagrangeMesh mesh) : mesh_(std::move(mesh)), map_(std::move(map)) {
  for (const surface::Block& block : map_.blocks().blocks) tables_[static_cast<std::size_t>(block.degree)] = table(block.degree);
  const std::int64_t* node = mesh_.connectivity.data();
  for (int e = 0; e < map_.n_elements(); ++e) {
    first_.push_back(static_cast<int>(place_.size()));
    NodeRange reach{static_cast<int>(*node), 0};
    for (int k = 0; k < map_.n_bezier(e); ++k, ++node) {
      const int i = static_cast<int>(*node);
      if (i == static_cast<int>(place_.size())) place_.push_back(k);
      reach = {std::min(reach.begin, i), std::max(reach.end, i + 1)};
    }
    reach_.push_back(reach);
  }
  first_.push_back(static_cast<int>(place_.size()));
}

/// Calls use(element, first node, end) for the nodes of the range that stand on an element first.
template <class Use>
void Nodes::each_element(NodeRange range, const Use& use) const {
  if (range.size() == 0) return;
  for (int e = mesh_.sites[static_cast<std::size_t>(range.begin)].element; e < map_.n_elements(); ++e) {
    const int begin = std::max(first_[static_cast<std::size_t>(e)], range.begin), end = std::min(first_[static_cast<std::size_t>(e) + 1], range.end);
    if (begin >= range.end) break;
    if (begin < end) use(e, begin, end);
  }
}

Net Nodes::values(const Net& control_values, NodeRange range) const {
  Net result(range.size(), 3);
  each_element(range, [&](int e, int begin, int end) {
    const int n = map_.n_bezier(e);
    double points[3 * most], at[3 * most];
    map_.points(e, control_values, points);
    at_nodes(n, table_of(e).value, points, at);
    for (int i = begin; i < end; ++i)
      for (int c = 0; c < 3; ++c) result(i - range.begin, c) = at[c * n + place_[static_cast<std::size_t>(i)]];
  });
  return result;
}

std::vector<surface::Jet> Nodes::jets(const Net& net, NodeRange range) const {
  std::vector<surface::Jet> result(static_cast<std::size_t>(range.size()));
  constexpr std::pair<std::vector<double> Table::*, Vec3 surface::Jet::*> parts[] = {
      {&Table::value, &surface::Jet::x}, {&Table::s, &surface::Jet::s},   {&Table::t, &surface::Jet::t},
      {&Table::ss, &surface::Jet::ss},   {&Table::st, &surface::Jet::st}, {&Table::tt, &surface::Jet::tt}};
  each_element(range, [&](int e, int begin, int end) {
    const int n = map_.n_bezier(e);
    double points[3 * most], at[3 * most];
    map_.points(e, net, points);
    for (const auto& [part, of_jet] : parts) {
      at_nodes(n, table_of(e).*part, points, at);
      for (int i = begin; i < end; ++i) {
        const double* here = at + place_[static_cast<std::size_t>(i)];
        result[static_cast<std::size_t>(i - range.begin)].*of_jet = Vec3(here[0], here[n], here[2 * n]);
      }
    }
  });
  return result;
}

bool Nodes::touches(int element, NodeRange range) const {
  const NodeRange& reach = reach_[static_cast<std::size_t>(element)];
  if (reach.begin >= range.end || reach.end <= range.begin) return false;
  const std::int64_t* const node = mesh_.connectivity.data() + mesh_.offsets[static_cast<std::size_t>(element)];
  return std::any_of(node, node + map_.n_bezier(element), [&](std::int64_t i) { return i >= range.begin && i < range.end; });
}

/// At the nodes of the cell, (3, n).
void Nodes::unit_normals(int element, const Net& net, double* normals) const {
  constexpr double degenerate = 1e-6;  // |a1 x a2| over |a1|_max |a2|_max of the element
  constexpr double inset = 1e-4;
  const Table& table = table_of(element);
  const int n = map_.n_bezier(element);
  double points[3 * most], a1[3 * most], a2[3 * most], length[most];
  map_.points(element, net, points);
  at_nodes(n, table.s, points, a1);
  at_nodes(n, table.t, points, a2);
  double longest_1 = 0, longest_2 = 0;
  for (int k = 0; k < n; ++k) {
    longest_1 = std::max(longest_1, a1[k] * a1[k] + a1[n + k] * a1[n + k] + a1[2 * n + k] * a1[2 * n + k]);
    longest_2 = std::max(longest_2, a2[k] * a2[k] + a2[n + k] * a2[n + k] + a2[2 * n + k] * a2[2 * n + k]);
    normals[k] = a1[n + k] * a2[2 * n + k] - a1[2 * n + k] * a2[n + k];
    normals[n + k] = a1[2 * n + k] * a2[k] - a1[k] * a2[2 * n + k];
    normals[2 * n + k] = a1[k] * a2[n + k] - a1[n + k] * a2[k];
    length[k] = std::sqrt(normals[k] * normals[k] + normals[n + k] * normals[n + k] + normals[2 * n + k] * normals[2 * n + k]);
  }
  const double least = degenerate * std::sqrt(longest_1 * longest_2);
  for (int k = 0; k < n; ++k) {
    if (length[k] < least) {
      const Vec3 inside = normal_inside({map_.degree(element), points}, table.order[static_cast<std::size_t>(k)], inset);
      for (int c = 0; c < 3; ++c) normals[c * n + k] = inside[c];
      length[k] = inside.norm();
    }
    if (length[k] > 0)
      for (int c = 0; c < 3; ++c) normals[c * n + k] /= length[k];
  }
}

Net Nodes::normals(const Net& net, NodeRange range) const {
  Net sum = Net::Zero(range.size(), 3);
  for (int e = 0; e < map_.n_elements(); ++e) {
    if (!touches(e, range)) continue;
    double normals[3 * most];
    unit_normals(e, net, normals);
    const std::int64_t* const node = mesh_.connectivity.data() + mesh_.offsets[static_cast<std::size_t>(e)];
    const int n = map_.n_bezier(e);
    for (int k = 0; k < n; ++k) {
      const int i = static_cast<int>(node[k]) - range.begin;
      if (i < 0 || i >= range.size()) continue;
      for (int c = 0; c < 3; ++c) sum(i, c) += normals[c * n + k];
    }
  }
  sum.rowwise().normalize();
  return sum;
}

}  // namespace tanktread::output
