#pragma once
// Fields of a spline surface at the nodes of its Lagrange mesh.

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "base/types.hpp"
#include "record/files/lagrange.hpp"
#include "spline/bernstein.hpp"
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
