#pragma once
// A spline surface as ParaView draws it: Lagrange quadrilaterals, which hold the same polynomials with true values at their nodes.

#include <cstdint>
#include <vector>

#include "base/types.hpp"
#include "spline/space.hpp"
#include "surface/bezier_points.hpp"
#include "surface/patch.hpp"

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

/// The nodes of a surface's Lagrange mesh and what any number of fields are there, with all that depends on the mesh alone made once.
class Nodes {
 public:
  Nodes(const spline::Space& space, LagrangeMesh mesh);

  const LagrangeMesh& mesh() const { return mesh_; }

  /// A field with control values (N, 3). Shape (n_nodes, 3).
  Net values(const Net& control_values) const;

  /// Places and derivatives of a surface, on the first element that has the node.
  std::vector<surface::Jet> jets(const Net& net) const;

  /// Exact outward unit normals, the mean over the elements that meet there. Shape (n_nodes, 3). Where an element degenerates (a pole) its
  /// normal is taken a hair inside.
  Net normals(const Net& net) const;

 private:
  /// Values and derivatives of the Bernstein polynomials at the nodes of a cell, shape (nodes, polynomials).
  struct Table {
    Eigen::MatrixXd value, s, t, ss, st, tt;
    explicit Table(int degree);
  };
  /// Where a node stands on its first element: the element's block and position in it, the node's number in the cell.
  struct Origin {
    int block, element, node;
  };
  using Cells = std::vector<Eigen::MatrixXd>;  ///< a number a node (or Bezier point), component and element of each block
  Cells bezier(const Net& net) const;
  Cells at_cells(const Cells& bezier, Eigen::MatrixXd Table::*part) const;

  LagrangeMesh mesh_;
  surface::BezierMap map_;
  std::vector<Table> tables_;  ///< of the blocks
  std::vector<Origin> origins_;
};

/// The same for a single use; control values (N, k) give shape (n_nodes, k).
Eigen::MatrixXd nodal_values(const spline::Space& space, const LagrangeMesh& mesh, const Eigen::MatrixXd& control_values);
Net nodal_normals(const spline::Space& space, const LagrangeMesh& mesh, const Net& net);

}  // namespace tanktread::output
