#pragma once
// Fields of a spline surface at the nodes of its Lagrange mesh.

#include <array>
#include <vector>

#include "base/types.hpp"
#include "output/lagrange.hpp"
#include "spline/bernstein.hpp"
#include "surface/bezier_points.hpp"
#include "surface/patch.hpp"

namespace tanktread::output {

/// Nodes in a row.
struct NodeRange {
  int begin = 0, end = 0;
  int size() const { return end - begin; }
};

/// The nodes of a surface's Lagrange mesh and what any number of fields are there, with all that depends on the mesh alone made once.
/// What is at a node does not depend, to the last bit, on the range with which it is asked for; without one, all nodes are meant.
class Nodes {
 public:
  Nodes(surface::BezierMap map, LagrangeMesh mesh);

  const LagrangeMesh& mesh() const { return mesh_; }
  NodeRange all() const { return {0, static_cast<int>(mesh_.sites.size())}; }

  /// A field with control values (N, 3). Shape (n_nodes, 3).
  Net values(const Net& control_values, NodeRange range) const;
  Net values(const Net& control_values) const { return values(control_values, all()); }

  /// Places and derivatives of a surface, on the first element that has the node.
  std::vector<surface::Jet> jets(const Net& net, NodeRange range) const;
  std::vector<surface::Jet> jets(const Net& net) const { return jets(net, all()); }

  /// Exact outward unit normals, the mean over the elements that meet there. Shape (n_nodes, 3). Where an element degenerates (a pole) its
  /// normal is taken a hair inside.
  Net normals(const Net& net, NodeRange range) const;
  Net normals(const Net& net) const { return normals(net, all()); }

 private:
  /// Values and derivatives of the n Bernstein polynomials at the n nodes of a cell: of polynomial b at node k in b n + k.
  struct Table {
    std::vector<double> value, s, t, ss, st, tt;
    std::vector<std::array<int, 2>> order;
  };
  static Table table(int degree);
  const Table& table_of(int element) const { return tables_[static_cast<std::size_t>(map_.degree(element))]; }
  bool touches(int element, NodeRange range) const;
  void unit_normals(int element, const Net& net, double* normals) const;
  template <class Use>
  void each_element(NodeRange range, const Use& use) const;

  LagrangeMesh mesh_;
  surface::BezierMap map_;
  std::array<Table, spline::max_degree + 1> tables_;  ///< by degree, of those that the mesh has
  std::vector<int> first_;        ///< of every element: the first node that no element before has, and the end
  std::vector<int> place_;        ///< of every node: its number in the cell of its first element
  std::vector<NodeRange> reach_;  ///< of every element: the range that holds all of its nodes
};

}  // namespace tanktread::output
