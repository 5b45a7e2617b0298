#pragma once
// A spline surface as ParaView draws it: Lagrange quadrilaterals, which hold the same polynomials with true values at their nodes.

#include <cstdint>
#include <vector>

#include "base/types.hpp"
#include "spline/space.hpp"

namespace tanktread::output {

/// One cell an element, of the element's degree p, with (p + 1)^2 nodes at (i/p, j/p); neighbours share the nodes that coincide.
///
/// Order of the nodes of a cell (VTK): corners (0,0) (p,0) (p,p) (0,p); edges j = 0, i = p, j = p, i = 0, each with its index
/// increasing; then the interior, i fastest.
struct LagrangeMesh {
  std::vector<std::int64_t> connectivity;  ///< node numbers, cell after cell
  std::vector<std::int64_t> offsets;       ///< n_cells + 1: where the nodes of a cell begin
  std::vector<spline::Site> sites;         ///< of every node, on the first element that has it: to sample what is no field of the space
};

/// `net` decides which nodes coincide; the unstressed surface is the best choice, since it does not change and never touches itself.
LagrangeMesh lagrange_mesh(const spline::Space& space, const Net& net);

/// A field with control values (N, k) at the nodes: shape (n_nodes, k).
Eigen::MatrixXd nodal_values(const spline::Space& space, const LagrangeMesh& mesh, const Eigen::MatrixXd& control_values);

/// Exact outward unit normals at the nodes, the mean over the elements that meet there. Shape (n_nodes, 3). Where an element
/// degenerates (a pole) its normal is taken a hair inside.
Net nodal_normals(const spline::Space& space, const LagrangeMesh& mesh, const Net& net);

}  // namespace tanktread::output
