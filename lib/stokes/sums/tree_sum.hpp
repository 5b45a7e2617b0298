#pragma once
// The far sum in a time proportional to the number of nodes.

#include <array>
#include <span>
#include <utility>
#include <vector>

#include "base/types.hpp"
#include "stokes/kernels/far_kernel.hpp"
#include "stokes/sums/clusters.hpp"
#include "surface/symmetry.hpp"

namespace tanktread::stokes {

/// sum_k K(x_k, x0_i) q_k for a kernel K over clusters of nodes and of targets, by Chebyshev interpolation on whichever side it saves work,
/// and one by one where clusters are close. Every sum is the kernel's own on other places: at nodes or Chebyshev nodes, for targets or
/// Chebyshev nodes. After Wang, Krasny & Vaughn, *A kernel-independent treecode based on barycentric Lagrange interpolation*, Commun. Comput.
/// Phys. 28, 2020, in its form with cluster-cluster interactions; boxes that turn with the surface are ours.
class TreeSum {
 public:
  /// `tolerance`: of the sum for the Stokeslet, relative to sum_k |f_k| / |x_k - x0_i|.
  explicit TreeSum(double tolerance, Precision precision = Precision::full);

  /// Takes places: nodes x, y, z in groups starts[g] .. starts[g + 1] - 1 that stay together, and all n targets. Row i + n k of the sums is that of
  /// the image of target i in reflections[k - 1]; the clusters of images are the images of clusters.
  void place(const double* x, const double* y, const double* z, std::span<const int> starts, std::span<const Vec3> targets,
             std::span<const surface::Reflection> reflections = {});

  /// States that the nodes act from their own places and from these vectors beyond, 0 among them if their own are meant: a lattice's. Before place(),
  /// and without reflections.
  void repeat(std::vector<Vec3> images) { images_ = std::move(images); }

  /// States which rows are wanted of the sums to come. A row does not depend on which others are wanted.
  void want(std::span<const int> rows);

  /// Whether these sums ask what node k carries: not all do where they are shared.
  bool asks(int k) const { return asked_[k]; }

  /// Rows wanted of the sum for what the nodes carry; values[Kernel::out i + c].
  template <class Kernel>
  void sum(const std::array<const double*, 6>& carried, double* values) {
    in_ = Kernel::in, out_ = Kernel::out, kernel_ = precision_ == Precision::single ? Kernel::single : Kernel::sum;
    sum(carried, values);
  }

  /// Both at once.
  template <class Kernel>
  void sum(const std::array<const double*, 6>& carried, std::span<const int> wanted, double* values) {
    want(wanted);
    sum<Kernel>(carried, values);
  }

  /// The sums to come are of one part of the interactions; those of parts 0 .. parts - 1, of the same places, charges and wanted rows, add up to the
  /// whole. Parts are of equal work, each of few clusters of nodes. Before want().
  void share(int part, int parts) { part_ = part, parts_ = parts; }

  long long interactions() const { return interactions_; }  ///< of the last sum
  std::size_t bytes() const;

 private:
  void sum(const std::array<const double*, 6>& carried, double* values);
  void collect(const std::array<const double*, 6>& carried);
  void mark(std::span<const int> wanted);
  int row(std::size_t k) const;
  void take_part();
  void ask();
  /// Clusters that meet, each as its Chebyshev nodes or as its points.
  struct Pair {
    int target, source, image;
    bool target_nodes, source_nodes;
  };
  void meet(const Cluster& target, const Cluster& source, int image);
  void note(const Cluster& target, bool target_nodes, const Cluster& source, bool source_nodes, int image);
  long long work(const Pair& pair) const;
  void add(const Pair& pair);
  void hand_down();
  Charges points() const;
  Charges nodes() const;

  Precision precision_;
  int part_ = 0, parts_ = 1;
  int in_ = 3, out_ = 3;  // of the kernel
  void (*kernel_)(const Charges&, const double*, double*) = nullptr;
  Clusters sources_, target_tree_;              // of the targets without their images
  std::vector<Vec3> images_{Vec3::Zero()};      // that the sources act from
  int n_trees_ = 1;                             // of targets: one, and its images
  std::vector<Cluster> targets_;                // of all trees, one after the other
  std::vector<double> q_[6], node_q_[6];        // what the sources and their Chebyshev nodes carry
  std::vector<double> target_at_, node_at_;     // targets and their Chebyshev nodes, in blocks
  std::vector<double> target_u_, node_u_;       // values there
  std::vector<char> row_, wanted_, has_nodes_;  // targets wanted; of target clusters: any of them wanted; values at Chebyshev nodes
  std::vector<Pair> pairs_;                     // of this part
  std::vector<char> asked_, in_use_;            // nodes that carry something to a target; source clusters whose Chebyshev nodes do
  std::vector<Pack> scratch_;
  long long interactions_ = 0;
};

}  // namespace tanktread::stokes
