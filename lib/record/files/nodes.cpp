#include "record/files/nodes.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include <Eigen/Geometry>

#include "spline/bernstein.hpp"
#include "surface/three_sums.hpp"

namespace tanktread::output {
namespace {

constexpr int n_parts = 6;  // of a jet

/// What each Bezier point of an element adds to the jets at the nodes of its cell. Shape (n, 6, n): point, part of the jet, node.
std::vector<double> jet_table(int p) {
  constexpr std::array<std::array<int, 2>, n_parts> derivatives{{{0, 0}, {1, 0}, {0, 1}, {2, 0}, {1, 1}, {0, 2}}};
  const auto order = node_order(p);
  std::vector<double> table;
  for (int b = 0; b < (p + 1) * (p + 1); ++b)
    for (const auto& [along_s, along_t] : derivatives)
      for (const auto& node : order) {
        double s[3][spline::max_degree + 1], t[3][spline::max_degree + 1];
        spline::bernstein(p, double(node[0]) / p, s[0], s[1], s[2]);
        spline::bernstein(p, double(node[1]) / p, t[0], t[1], t[2]);
        table.push_back(s[along_s][b % (p + 1)] * t[along_t][b / (p + 1)]);
      }
  return table;
}

/// Normals of an element, of any length, from the jets at the nodes of its cell.
std::vector<Vec3> cell_normals(const surface::Patch& patch, std::span<const surface::Jet> jets) {
  constexpr double degenerate = 1e-6;  // |a1 x a2| over |a1|_max |a2|_max of the element
  constexpr double inset = 1e-4;       // of the way to the middle
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
  for (const surface::Block& block : map_.blocks()) tables_[block.degree] = jet_table(block.degree);
}

/// Those at the nodes of its cell; the element's Bezier points.
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
  jets.clear();
  for (int k = 0; k < n; ++k) jets.push_back({part(0, k), part(1, k), part(2, k), part(3, k), part(4, k), part(5, k)});
  return points;
}

/// Calls use(patch, nodes, jets) for every element, the last first: what is set again is from the first element that has the node.
template <class Use>
void Nodes::each_cell(const Net& net, Use use) const {
  std::vector<surface::Jet> here;
  for (int e = map_.n_elements(); e-- > 0;) {
    const Points points = jets(e, net, here);
    use(surface::Patch{map_.degree(e), points.data()}, std::span(mesh_.connectivity).subspan(static_cast<std::size_t>(mesh_.offsets[e]), here.size()),
        here);
  }
}

Net Nodes::values(const Net& control_values) const {
  Net result(mesh_.sites.size(), 3);
  each_cell(control_values, [&](const surface::Patch&, std::span<const std::int64_t> nodes, const std::vector<surface::Jet>& here) {
    for (std::size_t k = 0; k < nodes.size(); ++k) result.row(nodes[k]) = here[k].x;
  });
  return result;
}

Net Nodes::normals(const Net& net) const {
  Net sum = Net::Zero(static_cast<Eigen::Index>(mesh_.sites.size()), 3);
  each_cell(net, [&](const surface::Patch& patch, std::span<const std::int64_t> nodes, const std::vector<surface::Jet>& here) {
    const std::vector<Vec3> normals = cell_normals(patch, here);
    for (std::size_t k = 0; k < nodes.size(); ++k) sum.row(nodes[k]) += normals[k].normalized();
  });
  sum.rowwise().normalize();
  return sum;
}

}  // namespace tanktread::output
