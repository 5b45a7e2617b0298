#pragma once
// A spline surface as ParaView draws it: Lagrange quadrilaterals, which hold the same polynomials with true values at their nodes.

#include <array>
#include <cstdint>
#include <vector>

#include "base/types.hpp"
#include "spline/space.hpp"

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

}  // namespace tanktread::output
