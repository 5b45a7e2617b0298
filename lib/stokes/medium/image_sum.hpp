#pragma once
// Far sums of the images of nodes in a plane wall.

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "stokes/kernels/far_kernel.hpp"
#include "stokes/medium/plane_wall.hpp"
#include "stokes/sums/tree_sum.hpp"

namespace tanktread::stokes {

/// sum_k G^I f_k or sum_k T^I S_k (stokes/kernels/image_kernel.hpp) of all nodes, every node for every target or by clusters: nodes where they
/// are, targets where they are mirrored, all in the wall's axes.
class ImageSum {
 public:
  enum class Kind { forces, stresslets };

  /// `tolerance`: of clusters, as TreeSum has it; none: no clusters.
  ImageSum(Kind kind, const PlaneWall& wall, std::optional<double> tolerance);

  const PlaneWall& wall() const { return wall_; }

  /// Shares the sums by clusters, as TreeSum does.
  void share(int part, int parts);

  /// Takes places of the nodes.
  void place(const std::vector<double> (&node)[3]);

  /// Takes all targets, and which of them are wanted; whether they are other ones than before, or nodes are.
  bool want(std::vector<Vec3> targets, std::vector<int> wanted);

  /// Rows for the targets wanted, in their order, of nodes that carry 3 numbers of forces, or 6 of S in the order 11, 22, 33, 12, 13, 23.
  Net sum(std::span<const std::vector<double>> carried);

  /// The same of few nodes from `first` on at one target: what a better rule takes back. `carried`: from those nodes on.
  Vec3 sum(const Charges& carried, int first, const Vec3& target) const;

  long long interactions() const { return interactions_; }  ///< of the last sum

 private:
  void turn(const Charges& carried, std::vector<double> (&own)[6]) const;
  Vec3 below(const Vec3& x) const { return wall_.in_axes(wall_.mirrored(x)); }
  KernelSum kernel() const;
  void sum_all(const Charges& charges, Net& sums) const;
  void sum_by_clusters(const Charges& charges, Net& sums);

  Kind kind_;
  PlaneWall wall_;
  std::optional<TreeSum> tree_;
  std::vector<double> node_[3];  // in the wall's axes
  std::vector<Vec3> targets_;    // in space
  std::vector<int> wanted_;
  bool placed_ = false;          // the targets, since the nodes were
  long long interactions_ = 0;
};

}  // namespace tanktread::stokes
