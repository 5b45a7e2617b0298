#pragma once
// Far-field sums of the images of nodes in a plane wall.

#include <optional>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "stokes/kernels/far_kernel.hpp"
#include "stokes/medium/plane_wall.hpp"
#include "stokes/sums/tree_sum.hpp"

namespace tanktread::stokes {

/// Evaluates sum_k G^I f_k or sum_k T^I S_k (stokes/kernels/image_kernel.hpp) over all nodes, directly or by clusters. Sources are the nodes at their
/// own positions; targets are replaced by their mirror images. All positions are in the wall's axes.
class ImageSum {
 public:
  enum class Kind { forces, stresslets };

  /// `tolerance`: tolerance of clusters as in TreeSum; if not set, the sum is direct.
  ImageSum(Kind kind, const PlaneWall& wall, std::optional<double> tolerance);

  const PlaneWall& wall() const { return wall_; }

  /// Shares the sums by clusters among ranks, see TreeSum::share().
  void share(int part, int parts);

  /// Sets the positions of the nodes.
  void set_sources(const std::vector<double> (&node)[3]);

  /// Sets all targets, and the indices of the targets (`wanted`) at which sum() returns the sums. Returns true if the targets, the indices or the
  /// nodes set by set_sources() have changed since the last call.
  bool want(std::vector<Vec3> targets, std::vector<int> wanted);

  /// Returns the sums at the targets selected by want(), one row per target, in the order of `wanted`. `strengths`: source strengths of the nodes,
  /// with 3 components (forces f_k) or 6 components (symmetric tensors S_k) in the order 11, 22, 33, 12, 13, 23.
  Net sum(std::span<const std::vector<double>> strengths);

  /// Returns the contribution of the nodes first, first + 1, ... to the sum at one target. `strengths`: source strengths of these nodes. The caller
  /// subtracts this contribution if near-singular quadrature replaces the nodes.
  Vec3 sum(const Charges& strengths, int first, const Vec3& target) const;

  long long interactions() const { return interactions_; }  ///< number of kernel evaluations of the last sum

 private:
  void turn(const Charges& strengths, std::vector<double> (&own)[6]) const;
  Vec3 below(const Vec3& x) const { return wall_.in_axes(wall_.mirrored(x)); }
  KernelSum kernel() const;

  Kind kind_;
  PlaneWall wall_;
  std::optional<TreeSum> tree_;
  std::vector<double> node_[3];  // far nodes in the axes of the wall
  std::vector<Vec3> targets_;    // targets in the laboratory frame
  std::vector<int> wanted_;
  bool placed_ = false;          // true if the targets have been set for the current nodes
  long long interactions_ = 0;
};

}  // namespace tanktread::stokes
