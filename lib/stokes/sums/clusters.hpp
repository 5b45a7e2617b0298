#pragma once
// Points in nested boxes. Each box has Chebyshev nodes that replace its points for distant targets or sources.

#include <cmath>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "stokes/kernels/cluster_kernel.hpp"

namespace tanktread::stokes {

/// One box of a tree.
struct Cluster : ChebyshevBox {
  int first = 0, last = 0;       ///< range of the box's points, in the order of the tree
  int child[2] = {-1, -1};       ///< indices of the children; -1 for a leaf
  int first_node = 0;            ///< index of the box's first Chebyshev node among the nodes of all clusters
  int first_block = 0;           ///< index of the box's first block of nodes among the blocks of all clusters; a block has far_block nodes
  double radius = 0, reach = 0;  ///< radius: half the box's diagonal. reach: distance from the centre beyond which interpolation at the Chebyshev
                                 ///< nodes is accurate
  bool bare = false;             ///< true: the box has no Chebyshev nodes, because they would cost no less than its points; its points are
                                 ///< used instead

  bool leaf() const { return child[0] < 0; }
  int n_points() const { return last - first; }

  /// Returns whether interpolation at the Chebyshev nodes of this box is accurate for interactions with `other`, shifted by `beyond`. One of the two
  /// boxes contains sources, the other one targets.
  bool serves(const ChebyshevBox& other, const Vec3& beyond) const;
};

/// A binary tree over points. The points come in groups: the far nodes of one panel, or single points. A group is never split. The box of a flat
/// cluster has an axis along the cluster's normal, so that a patch of a surface needs only two or three nodes across its thickness.
///
/// Consider a box with half-width a and n Chebyshev nodes along one axis. At the distance z a from its centre, interpolation of G (2.1) along this
/// axis has an error of rho^(-n), where rho = z + sqrt(z^2 - 1), cf. (2.9). Along the longest axis, n is chosen from the tolerance, and `reach` is
/// the distance z a at which the error equals the tolerance. Along the other axes, n is the smallest number that gives the tolerance at the distance
/// `reach`.
class Clusters {
 public:
  /// `leaf`: largest number of points in a leaf, except in a cluster that cannot be split. `quantum`: a cluster is split so that the number of groups
  /// in its first half is a multiple of `quantum`. The cost of n points or nodes is assumed to be proportional to n rounded up to a multiple of
  /// `quantum`.
  Clusters(double tolerance, int leaf, int quantum) : tolerance_(tolerance), leaf_(leaf), quantum_(quantum) {}

  /// Builds the tree. Group g contains the points starts[g] .. starts[g + 1] - 1. The tree depends on the positions only, and rounding errors hardly
  /// ever change it.
  void set_sources(const std::vector<double> (&x)[3], std::span<const int> starts);

  const std::vector<Cluster>& all() const { return clusters_; }  ///< parents before their children
  const std::vector<int>& order() const { return order_; }       ///< indices of the points in the order of the tree
  const std::vector<double> (&points() const)[3] { return point_; }  ///< positions of the points in the order of the tree
  const std::vector<double> (&nodes() const)[3] { return node_; }    ///< positions of the Chebyshev nodes
  int n_nodes() const { return static_cast<int>(node_[0].size()); }
  int n_blocks() const { return n_blocks_; }

 private:
  struct Group {
    Vec3 centre;
    double along;  // coordinate of `centre` on the axis along which the group's cluster is split
    int number;
  };
  double rounded(double x) const { return step_ * std::round(x / step_); }
  int split(int first, int last, Mat3 axes, std::span<const int> starts);
  void enclose(Cluster& cluster);

  double tolerance_;
  double step_ = 1;  // resolution at which positions are compared [length]
  int leaf_, quantum_;
  std::vector<Group> groups_;
  std::vector<Cluster> clusters_;
  std::vector<int> order_;
  std::vector<double> point_[3], node_[3];
  int n_blocks_ = 0;
};

}  // namespace tanktread::stokes
