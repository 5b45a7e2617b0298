#pragma once
// Far sums of a layer by clusters.

#include <span>
#include <utility>
#include <vector>

#include "base/types.hpp"
#include "stokes/layer_sources.hpp"
#include "stokes/medium/layer_medium.hpp"
#include "stokes/sums/tree_sum.hpp"

namespace tanktread::stokes {

/// Returns the positions of the targets `rows`, each moved into the unit cell if the medium is a lattice.
std::vector<Vec3> wrapped(const LayerMedium& medium, const LayerTargets& targets, std::span<const int> rows);

/// Sums over the far nodes of a layer by clusters of nodes and of targets (TreeSum).
class ClusterSums {
 public:
  /// `tolerance`: see TreeSum.
  explicit ClusterSums(double tolerance) : tree_(tolerance) {}

  void share(int part, int parts);          ///< see TreeSum::share
  void repeat(std::vector<Vec3> images);    ///< see TreeSum::repeat. Must be called for each shape
  void renew() { rows_.clear(); }           ///< makes the next sum build the clusters anew, because the shape or its symmetry has changed

  /// Sets the rows targets.far_rows of u to the sums of the kernel times the density over all far nodes, without the factor 1/(8 pi).
  void set_sums(LayerSources& sources, const LayerMedium& medium, const LayerTargets& targets, Net& u);

 private:
  void place(LayerSources& sources, const LayerMedium& medium, const LayerTargets& targets);
  void set_sums_of_forces(LayerSources& sources, const LayerMedium& medium, const LayerTargets& targets, Net& u);
  void set_sums_of_stresslets(LayerSources& sources, const LayerTargets& targets, Net& u);

  TreeSum tree_;
  std::vector<Vec3> at_;        // positions of the targets of the tree
  std::vector<int> rows_;       // rows that the tree computes; empty if the tree must be built anew
  std::vector<double> stress_;  // double layer: sum of T_ijk n_k over the far nodes at the targets, six components each
};

}  // namespace tanktread::stokes
