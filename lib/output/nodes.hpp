#pragma once
// Fields of a spline surface at the nodes of its Lagrange mesh.

#include <map>
#include <vector>

#include "base/types.hpp"
#include "output/lagrange.hpp"
#include "surface/bezier_points.hpp"
#include "surface/patch.hpp"

namespace tanktread::output {

/// The nodes of a surface's Lagrange mesh, and what any number of fields are there.
class Nodes {
 public:
  Nodes(surface::BezierMap map, LagrangeMesh mesh);

  const LagrangeMesh& mesh() const { return mesh_; }

  /// A field with control values (N, 3). Shape (n_nodes, 3).
  Net values(const Net& control_values) const;

  /// Places and derivatives of a surface, on the first element that has the node.
  std::vector<surface::Jet> jets(const Net& net) const;

  /// Exact outward unit normals, the mean over the elements that meet there. Shape (n_nodes, 3). Where an element degenerates (a pole) its
  /// normal is taken a hair inside.
  Net normals(const Net& net) const;

 private:
  template <class Use>
  void each_cell(const Net& net, Use use) const;

  surface::BezierMap map_;
  LagrangeMesh mesh_;
  std::map<int, std::vector<double>> tables_;  ///< by degree
};

}  // namespace tanktread::output
