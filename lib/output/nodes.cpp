#include "output/nodes.hpp"

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>

namespace tanktread::output {
namespace {

/// Normals of an element at the nodes of its cell, of any length.
std::vector<Vec3> cell_normals(const surface::Patch& patch) {
  constexpr double degenerate = 1e-6;  // |a1 x a2| over |a1|_max |a2|_max of the element
  constexpr double inset = 1e-4;       // of the way to the middle
  const auto order = node_order(patch.degree);
  const auto at = [&](const std::array<int, 2>& node, double inwards) {
    const double s = double(node[0]) / patch.degree, t = double(node[1]) / patch.degree;
    return surface::jet(patch, s + inwards * (0.5 - s), t + inwards * (0.5 - t));
  };
  double longest_1 = 0, longest_2 = 0;
  std::vector<Vec3> normals;
  for (const auto& node : order) {
    const surface::Jet here = at(node, 0);
    longest_1 = std::max(longest_1, here.s.norm());
    longest_2 = std::max(longest_2, here.t.norm());
    normals.push_back(here.s.cross(here.t));
  }
  for (std::size_t k = 0; k < order.size(); ++k)
    if (normals[k].norm() < degenerate * longest_1 * longest_2) {
      const surface::Jet inside = at(order[k], inset);
      normals[k] = inside.s.cross(inside.t);
    }
  return normals;
}

}  // namespace

Nodes::Nodes(surface::BezierMap map, LagrangeMesh mesh) : map_(std::move(map)), mesh_(std::move(mesh)) {}

Net Nodes::values(const Net& control_values) const {
  const surface::Patches patches(map_, control_values);
  Net result(mesh_.sites.size(), 3);
  Eigen::Index k = 0;
  for (const auto& [element, s, t] : mesh_.sites) result.row(k++) = surface::place(patches[element], s, t);
  return result;
}

std::vector<surface::Jet> Nodes::jets(const Net& net) const {
  const surface::Patches patches(map_, net);
  std::vector<surface::Jet> result;
  for (const auto& [element, s, t] : mesh_.sites) result.push_back(surface::jet(patches[element], s, t));
  return result;
}

Net Nodes::normals(const Net& net) const {
  const surface::Patches patches(map_, net);
  Net sum = Net::Zero(static_cast<Eigen::Index>(mesh_.sites.size()), 3);
  const std::int64_t* node = mesh_.connectivity.data();
  for (int e = 0; e < patches.size(); ++e)
    for (const Vec3& normal : cell_normals(patches[e])) sum.row(*node++) += normal.normalized();
  sum.rowwise().normalize();
  return sum;
}

}  // namespace tanktread::output
