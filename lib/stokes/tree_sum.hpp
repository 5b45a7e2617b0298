#pragma once
// The far sum in a time proportional to the number of nodes.

#include <span>
#include <vector>

#include "base/types.hpp"
#include "stokes/clusters.hpp"

namespace tanktread::stokes {

/// u_i = sum_k G(x_k, x0_i) f_k (2.1) over clusters of nodes and of targets, by Chebyshev interpolation on whichever side it saves work, and
/// one by one where clusters are close. Every sum is far_sum() on other places: at nodes or Chebyshev nodes, for targets or Chebyshev nodes.
/// After Wang, Krasny & Vaughn, *A kernel-independent treecode based on barycentric Lagrange interpolation*, Commun. Comput. Phys. 28, 2020,
/// in its form with cluster-cluster interactions; boxes that turn with the surface are ours.
class TreeSum {
 public:
  /// `tolerance`: of the sum, relative to sum_k |f_k| / |x_k - x0_i|.
  explicit TreeSum(double tolerance);

  /// Takes places: nodes x, y, z in groups starts[g] .. starts[g + 1] - 1 that stay together, and all targets.
  void place(const double* x, const double* y, const double* z, std::span<const int> starts, std::span<const Vec3> targets);

  /// Rows `wanted` of u for forces at the nodes. A row does not depend on which others are wanted.
  void sum(const double* fx, const double* fy, const double* fz, std::span<const int> wanted, Net& u);

  long long interactions() const { return interactions_; }  ///< of the last sum
  std::size_t bytes() const;

 private:
  void collect(const double* fx, const double* fy, const double* fz);
  void mark(std::span<const int> wanted);
  void meet(const Cluster& target, const Cluster& source);
  void add(const Cluster& target, bool target_nodes, const Cluster& source, bool source_nodes);
  void hand_down();

  Clusters sources_, targets_;
  std::vector<double> force_[3], node_force_[3];  // of the sources and of their Chebyshev nodes
  std::vector<double> target_at_, node_at_;       // targets and their Chebyshev nodes, in blocks
  std::vector<double> target_u_, node_u_;         // velocities there
  std::vector<char> wanted_, has_nodes_;          // of target clusters: any row wanted; velocity at Chebyshev nodes
  std::vector<Pack> scratch_;
  long long interactions_ = 0;
};

}  // namespace tanktread::stokes
