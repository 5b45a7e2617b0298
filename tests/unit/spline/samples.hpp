#pragma once
// Random fields and their derivatives across the sides of elements, for the tests of this module.

#include <array>
#include <map>
#include <random>
#include <vector>

#include "base/types.hpp"
#include "spline/basis.hpp"
#include "spline/t_mesh.hpp"

namespace tanktread::spline {

inline Net random_net(int n, unsigned seed) {
  std::mt19937 generator(seed);
  Net net(n, 3);
  for (Eigen::Index i = 0; i < net.size(); ++i) net.data()[i] = 2.0 * generator() / std::mt19937::max() - 1;
  return net;
}

/// Returns the control points of an element, shape (m, 3).
inline Eigen::MatrixXd net_of(const Element& e, const Net& net) {
  Eigen::MatrixXd out(Eigen::Index(e.points.size()), 3);
  for (std::size_t i = 0; i < e.points.size(); ++i) out.row(Eigen::Index(i)) = net.row(e.points[i]);
  return out;
}

/// Returns the lattice vertices at the corners of a rectangle, outward orientation.
inline std::array<int, 4> corners(const Lattice& lattice, const Rectangle& r) {
  std::array<int, 4> out;
  for (int k = 0; k < 4; ++k) out[k] = sides(lattice, r)[k].vertex;
  return out;
}

inline Vec3 value_at(const Space& s, const Net& net, const Site& site) {
  const Element& e = s.elements[site.element];
  return (basis(e, site.s, site.t, 0).value.transpose() * net_of(e, net)).transpose();
}

inline Eigen::MatrixXd collocation_matrix(const Space& s) {
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(s.n_points, s.n_points);
  for (int i = 0; i < s.n_points; ++i) {
    const Site& site = s.collocation[i][0];
    const Element& e = s.elements[site.element];
    const Basis b = basis(e, site.s, site.t, 0);
    for (std::size_t k = 0; k < e.points.size(); ++k) C(i, e.points[k]) += b.value[Eigen::Index(k)];
  }
  return C;
}

/// A whole side that two elements share: edge 0 (t = 0), 1 (s = 1), 2 (t = 1), 3 (s = 0) of each.
struct SharedSide {
  std::array<int, 2> element, edge;
};
/// Returns the sides that are whole sides of two elements. The elements of the space must be the tiles of the Bezier mesh.
inline std::vector<SharedSide> shared_sides(const TMesh& mesh, const Space& s) {
  std::map<std::pair<int, int>, std::pair<int, int>> open;
  std::vector<SharedSide> out;
  const Tiling tiling = bezier_mesh(mesh);
  for (int k = 0; k < int(s.elements.size()); ++k) {
    const auto c = corners(*mesh.lattice, tiling.tiles[k]);
    for (int e = 0; e < 4; ++e) {
      const auto other = open.find({c[(e + 1) & 3], c[e]});
      if (other != open.end())
        out.push_back({{other->second.first, k}, {other->second.second, e}});
      else
        open[{c[e], c[(e + 1) & 3]}] = {k, e};
    }
  }
  return out;
}

/// A field at a point of an edge of an element: value, first and second outward derivative across the edge, and derivative along it. Derivatives are
/// with respect to lengths in units of one tenth of the side of the macro face.
struct Jet {
  Vec3 value, slope, bend, along;
};
inline Jet jet_across(const Space& space, const Net& net, int element, int edge, double x) {
  const Element& e = space.elements[element];
  const double at[4][2] = {{x, 0}, {1, x}, {1 - x, 1}, {0, 1 - x}};
  const Basis b = basis(e, at[edge][0], at[edge][1], 2);
  const Eigen::MatrixXd P = net_of(e, net);
  auto field = [&](const Eigen::VectorXd& n) -> Vec3 { return (n.transpose() * P).transpose(); };
  const bool vertical = edge & 1;
  const double sign = edge == 0 || edge == 3 ? -1 : 1, unit = 0.1, h = e.size[vertical ? 0 : 1] / unit, w = e.size[vertical ? 1 : 0] / unit;
  return {field(b.value), sign / h * field(vertical ? b.s : b.t), field(vertical ? b.ss : b.tt) / (h * h), field(vertical ? b.t : b.s) / w};
}

}  // namespace tanktread::spline
