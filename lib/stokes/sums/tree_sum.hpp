#pragma once
// Far-field sums by a treecode, in a time proportional to the number of nodes.

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "base/threads.hpp"
#include "base/types.hpp"
#include "stokes/kernels/cluster_kernel.hpp"
#include "stokes/kernels/far_kernel.hpp"
#include "stokes/sums/clusters.hpp"
#include "surface/symmetry.hpp"

namespace tanktread::stokes {

/// Evaluates sum_k K(x_k, x0_i) q_k for a kernel K. Chebyshev interpolation replaces a distant cluster of nodes, of targets, or both if this saves
/// work; close clusters are summed directly. Every partial sum evaluates the kernel itself, at nodes or Chebyshev nodes as sources, and at targets or
/// Chebyshev nodes as targets. After Wang, Krasny & Vaughn, *A kernel-independent treecode based on barycentric Lagrange interpolation*, Commun.
/// Comput. Phys. 28, 2020, in its form with cluster-cluster interactions; boxes aligned with the surface are our addition.
class TreeSum {
 public:
  /// `tolerance`: error of the sum for the Stokeslet, relative to sum_k |f_k| / |x_k - x0_i|.
  explicit TreeSum(double tolerance);

  /// Sets the positions x of the nodes, and all n targets. The nodes starts[g] .. starts[g + 1] - 1 (group g) always stay in the same cluster. The
  /// sums have n rows for the targets, followed by n rows for each entry of `reflections`: row i + n k belongs to target i reflected by reflections[k
  /// - 1]. The clusters of reflected targets are the reflections of the clusters of targets.
  void set_sources(const std::vector<double> (&x)[3], std::span<const int> starts, std::span<const Vec3> targets,
                   std::span<const surface::Reflection> reflections = {});

  /// Sets the lattice vectors by which the sources are displaced; include 0 for the sources themselves. Must be called before set_sources(). If
  /// there are other lattice vectors than 0, set_sources() must be called without `reflections`.
  void repeat(std::vector<Vec3> images) { images_ = std::move(images); }

  /// Sets the rows that later sums compute. A row does not depend on which other rows are computed.
  void want(std::span<const int> rows);

  /// Computes the rows of the sum that want() has selected, from the source `strengths` of the nodes, one array per component. Component c of
  /// row i is values[Kernel::out i + c].
  template <class Kernel>
  void sum(const std::array<const double*, 6>& strengths, double* values) {
    static_assert(has_cluster_kernel(Kernel::in) && has_cluster_kernel(Kernel::out));
    in_ = Kernel::in, out_ = Kernel::out, kernel_ = Kernel::sum;
    sum(strengths, values);
  }

  /// Restricts later sums to one part of the pairs of clusters. For equal positions, source strengths and rows, the sums of parts 0 .. parts - 1 add
  /// up to the complete sum. Parts have equal work, and each uses few source clusters. Must be called before want().
  void share(int part, int parts) { part_ = part, parts_ = parts; }

  long long interactions() const { return interactions_; }  ///< number of kernel evaluations of the last sum

 private:
  void sum(const std::array<const double*, 6>& strengths, double* values);
  void spread_strengths(const std::array<const double*, 6>& strengths);
  void mark_targets(std::span<const int> wanted);
  int row(std::size_t k) const;
  void keep_part();
  void mark_sources();
  /// A pair of interacting clusters. Each of the two acts through its Chebyshev nodes (true) or through its points (false).
  struct Pair {
    int target, source, image;
    bool target_nodes, source_nodes;
  };
  /// The sums at the Chebyshev nodes of a target cluster, or at the targets in a leaf, in blocks of far_block. `pairs`: indices in pairs_ of all
  /// pairs that contribute, in ascending order.
  struct Share {
    int first_block, last_block;
    std::vector<int> pairs;
  };
  void pair_up(const Cluster& target, const Cluster& source, int image);
  void add_pair(const Cluster& target, bool target_nodes, const Cluster& source, bool source_nodes, int image);
  long long work(const Pair& pair) const;
  void add(const Pair& pair, int first_block, int last_block);
  void collect();
  void interpolate_downwards();

  int part_ = 0, parts_ = 1;
  int in_ = 3, out_ = 3;  // in_: number of components of a source strength. out_: number of components of the sum at a target
  void (*kernel_)(const Charges&, const double*, double*) = nullptr;
  Clusters sources_, target_tree_;              // sources_: tree of the sources. target_tree_: tree of the targets, without their reflections
  std::vector<Vec3> images_{Vec3::Zero()};      // displacements of the sources
  int n_trees_ = 1;                             // number of target trees: one for the targets, and one for each reflection of the targets
  std::vector<Cluster> targets_;                // clusters of all target trees, one tree after the other
  std::vector<double> q_[6], node_q_[6];        // strengths of the sources and of the Chebyshev nodes of source clusters, one array for each of up to
                                                // six components
  std::vector<double> target_at_, node_at_;     // positions of targets and of Chebyshev nodes of target clusters, in blocks of far_block points
  std::vector<double> target_u_, node_u_;       // values at targets and at the Chebyshev nodes of target clusters
  std::vector<char> row_, wanted_, has_nodes_;  // flags. row_: true if the sum of the row is requested. wanted_: true if the target cluster contains
                                                // a requested row. has_nodes_: true if the target cluster has values at its Chebyshev nodes
  std::vector<Pair> pairs_;                     // pairs of clusters whose interactions this part sums
  std::vector<Share> shares_;                   // shares of the sums, whose targets are disjoint
  std::vector<std::vector<int>> levels_[2];     // source clusters [0] and target clusters [1] by their distance from the root
  std::vector<char> in_use_;                    // flags of the source clusters whose Chebyshev nodes are used
  PerThread<std::vector<Pack>> scratch_;
  long long interactions_ = 0;
};

}  // namespace tanktread::stokes
