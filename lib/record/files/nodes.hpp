#pragma once
// Fields of a spline surface at the nodes of its Lagrange mesh.

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "spline/bernstein.hpp"
#include "spline/space.hpp"
#include "surface/bezier_points.hpp"
#include "surface/patch.hpp"

namespace tanktread::output {

/// Lagrange mesh of a surface: one cell per element, of the element's degree p, with (p + 1)^2 nodes at the parameters (i/p, j/p), i, j = 0 ... p.
/// Neighbouring cells share coinciding nodes.
///
/// Order of the nodes of a cell (VTK): corners (0,0) (p,0) (p,p) (0,p); edges j = 0, i = p, j = p, i = 0, each with increasing index; then the
/// interior, i fastest. Nodes are numbered in the order in which they first occur, cell by cell.
struct LagrangeMesh {
  std::vector<std::int64_t> connectivity;  ///< node numbers, cell after cell
  std::vector<std::int64_t> offsets;       ///< index in `connectivity` of the first node of each cell, and the total number at the end
  std::vector<spline::Site> sites;         ///< parametric point of every node on the first element that contains it, for sampling quantities that
                                           ///< are not spline fields
};

/// Builds the Lagrange mesh of one or several closed surfaces. Nodes of one surface are shared if they coincide on the surface with the control net
/// `net`. The unstressed surface is the best choice because it does not change and never touches itself.
/// `surface_of_element`: number of the surface of each element, see surfaces(); if empty, there is one surface.
LagrangeMesh lagrange_mesh(const spline::Space& space, const Net& net, const std::vector<int>& surface_of_element = {});

/// Returns a number per element, which is equal for two elements of one surface: elements that share control points, directly or through others.
std::vector<int> surfaces(const spline::Space& space);

/// Returns the indices (i, j) of the nodes of a cell of degree p, in VTK's order (LagrangeMesh).
std::vector<std::array<int, 2>> node_order(int p);

/// Evaluates fields at the nodes of a surface's Lagrange mesh.
class Nodes {
 public:
  Nodes(surface::BezierMap map, LagrangeMesh mesh);

  const LagrangeMesh& mesh() const { return mesh_; }

  /// Returns the values of a field with control values of shape (N, 3), at the nodes. Shape (n_nodes, 3).
  Net values(const Net& control_values) const;

  /// Calls use(node, jet_before, jet_now) for every node in order. The jets are the position and derivatives at the node of the surfaces `before` and
  /// `now`, evaluated on the first element that contains the node.
  template <class Use>
  void each_node(const Net& before, const Net& now, Use use) const {
    std::vector<surface::Jet> jets_before, jets_now;
    std::int64_t node = 0;
    for (int e = 0; e < map_.n_elements(); ++e) {
      jets(e, before, jets_before), jets(e, now, jets_now);
      for (std::size_t k = 0; k < jets_now.size(); ++k)
        if (mesh_.connectivity[static_cast<std::size_t>(mesh_.offsets[e]) + k] == node) use(node++, jets_before[k], jets_now[k]);
    }
  }

  /// Returns the outward unit normals of the spline surface at the nodes, shape (n_nodes, 3). If several elements meet at a node, their normals are
  /// averaged. If an element is degenerate at a node (a pole), its normal is evaluated at a point slightly inside the element.
  Net normals(const Net& net) const;

 private:
  /// Bezier points, shape (3, n_bezier); storage for the largest degree
  using Points = std::array<double, 3 * (spline::most_polynomial_degree + 1) * (spline::most_polynomial_degree + 1)>;
  std::span<const std::int64_t> cell(int element) const;
  Points jets(int element, const Net& net, std::vector<surface::Jet>& jets) const;

  surface::BezierMap map_;
  LagrangeMesh mesh_;
  std::map<int, std::vector<double>> tables_, values_;  ///< jet_table of each degree, and its rows of positions
};

}  // namespace tanktread::output
