#pragma once
// Fields of a spline surface at the nodes of its Lagrange mesh.

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "base/types.hpp"
#include "spline/bernstein.hpp"
#include "spline/space.hpp"
#include "surface/bezier_points.hpp"
#include "surface/patch.hpp"

namespace tanktread::output {

/// One cell an element, of the element's degree p, with (p + 1)^2 nodes at (i/p, j/p); neighbours share the nodes that coincide.
///
/// Order of the nodes of a cell (VTK): corners (0,0) (p,0) (p,p) (0,p); edges j = 0, i = p, j = p, i = 0, each with its index
/// increasing; then the interior, i fastest. Nodes are numbered as they first come up, cell after cell.
struct LagrangeMesh {
  std::vector<std::int64_t> connectivity;  ///< node numbers, cell after cell
  std::vector<std::int64_t> offsets;       ///< n_cells + 1: where the nodes of a cell begin
  std::vector<spline::Site> sites;         ///< of every node, on the first element that has it: to sample what is no field of the space
};

/// `net` decides which nodes coincide; the unstressed surface is the best choice, since it does not change and never touches itself.
LagrangeMesh lagrange_mesh(const spline::Space& space, const Net& net);

/// (i, j) of the nodes of a cell of degree p, in their order.
std::vector<std::array<int, 2>> node_order(int p);

/// The nodes of a surface's Lagrange mesh, and what any number of fields are there.
class Nodes {
 public:
  Nodes(surface::BezierMap map, LagrangeMesh mesh);

  const LagrangeMesh& mesh() const { return mesh_; }

  /// A field with control values (N, 3). Shape (n_nodes, 3).
  Net values(const Net& control_values) const;

  /// Calls use(node, before, now) for every node in order, with places and derivatives of two surfaces on the first element that has it.
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

  /// Exact outward unit normals, the mean over the elements that meet there. Shape (n_nodes, 3). Where an element degenerates (a pole) its
  /// normal is taken a hair inside.
  Net normals(const Net& net) const;

 private:
  using Points = std::array<double, 3 * (spline::max_degree + 1) * (spline::max_degree + 1)>;  ///< shape (3, n_bezier), as far as they go
  template <class Use>
  void each_cell(const Net& net, Use use) const;
  Points jets(int element, const Net& net, std::vector<surface::Jet>& jets) const;

  surface::BezierMap map_;
  LagrangeMesh mesh_;
  std::map<int, std::vector<double>> tables_;  ///< by degree
};

}  // namespace tanktread::output
