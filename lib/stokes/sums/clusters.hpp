#pragma once
// Points in nested boxes, each with Chebyshev nodes that stand for its points where they are far away.

#include <span>
#include <vector>

#include "base/types.hpp"
#include "stokes/kernels/cluster_kernel.hpp"

namespace tanktread::stokes {

/// One box of a tree.
struct Cluster : ChebyshevBox {
  int first = 0, last = 0;       ///< its points, in the order of the tree
  int child[2] = {-1, -1};       ///< -1: a leaf
  int first_node = 0;            ///< of its Chebyshev nodes among those of all clusters
  int first_block = 0;           ///< the same in blocks of far_block
  double radius = 0, reach = 0;  ///< half the diagonal; distance from the centre beyond which the nodes serve
  bool bare = false;             ///< without nodes, for its points are no more; what is above it then deals with its points

  bool leaf() const { return child[0] < 0; }
  int n_points() const { return last - first; }

  /// Whether its nodes stand for its points as seen from the other box, moved by `beyond`, or for targets in it as seen from there.
  bool serves(const ChebyshevBox& other, const Vec3& beyond) const;
};

/// A binary tree over points that come in groups (the far nodes of a panel, or single points); a group is never split. Boxes of flat clusters
/// turn with them, so that a patch of a surface needs two or three nodes across.
///
/// Interpolation of G (2.1) along the half-width a of a box with n nodes errs like rho^(-n) at the distance z a from its centre,
/// rho = z + sqrt(z^2 - 1), cf. (2.9): n along the longest axis follows from the tolerance, reach = z a from n, and the other n from reach.
class Clusters {
 public:
  /// Leaves hold `leaf` points at most (or one group); both halves of a cluster begin at a multiple of `quantum` groups. Points and nodes cost as
  /// much as multiples of it.
  Clusters(double tolerance, int leaf, int quantum) : tolerance_(tolerance), leaf_(leaf), quantum_(quantum) {}

  /// Builds the tree. Group g holds the points starts[g] .. starts[g + 1] - 1. A pure function of the places.
  void place(const double* x, const double* y, const double* z, std::span<const int> starts);

  const std::vector<Cluster>& all() const { return clusters_; }  ///< parents before their children
  const std::vector<int>& order() const { return order_; }       ///< numbers of the points in the order of the tree
  const double* point(int c) const { return point_[c].data(); }  ///< their places
  const double* node(int c) const { return node_[c].data(); }    ///< places of the Chebyshev nodes
  int n_nodes() const { return static_cast<int>(node_[0].size()); }
  int n_blocks() const { return n_blocks_; }
  std::size_t bytes() const;

 private:
  struct Group {
    Vec3 centre;
    double along;  // the axis that its cluster is halved along
    int number;
  };
  int split(int first, int last, Mat3 axes, std::span<const int> starts);
  void enclose(Cluster& cluster);

  double tolerance_;
  int leaf_, quantum_;
  std::vector<Group> groups_;
  std::vector<Cluster> clusters_;
  std::vector<int> order_;
  std::vector<double> point_[3], node_[3];
  int n_blocks_ = 0;
};

}  // namespace tanktread::stokes
