#pragma once
// The single layer that the Jacobian keeps frozen, by one node a control point and corrections for near ones.

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "stokes/layer.hpp"
#include "stokes/sums/tree_sum.hpp"
#include "surface/symmetry.hpp"

namespace tanktread::coupling {

/// A of (4.2) as the trapezoidal rule at the collocation sites x_B, corrected where control points are near the target:
///
///   (A f)_i = sum_B G(x_B, x_i) w_B (R f)_B / 8 pi  +  sum over near C of K_iC f_C,   w_B = int N_B dG0                         (4.11)
///   K_iC = A_iC - sum_B G(x_B, x_i) w_B R_BC / 8 pi
///
/// A node at the target counts as nothing. The sum is taken on the fly, in double precision: the noise of single precision would grow, from step to
/// step, to what tells symmetric runs from whole ones (1e-8 of D). It needs no memory but for the near blocks, some thirty a target, and is taken
/// by clusters on a large surface. What it leaves out of A is the rule's error at a distance of a few elements, which costs a quasi-Newton iteration
/// some contraction and no accuracy.
class NodalOperator {
 public:
  struct Surface {
    Net sites;                          ///< x_B
    Eigen::SparseMatrix<double> values;  ///< R, shape (N, N)
    Eigen::VectorXd weights;             ///< w_B
    Eigen::VectorXd areas;               ///< present ones: a control point C is near where |x_C - x_i| < reach sqrt(area_C)
    surface::Symmetry symmetry;          ///< of surface and densities; of no points: none
  };

  /// Fills blocks A_iC of near control points as Layer::assemble does.
  using Assemble = std::function<void(std::span<const int> targets, const stokes::NearPoints& near, std::vector<double>& entries)>;

  /// `far_sum`: as in quadrature::Options.
  void assemble(const std::vector<int>& targets, const Surface& surface, double reach, const std::string& far_sum, const Assemble& assemble);

  /// States that ranks share sums by clusters: this one takes a part of equal work of the rows of `everybody`, in which its targets are.
  void share(int part, int parts, std::vector<int> everybody);

  /// Rows of the own targets of u = A f; other rows are untouched. Where sums are shared, what this rank adds to the rows of everybody.
  void apply(const Net& f, Net& u);

  /// Whether the ranks' u add up to A f.
  bool shared() const { return tree_ && parts_ > 1; }

  bool empty() const { return targets_.empty(); }

 private:
  void find_near(const Surface& surface, double reach);
  void subtract_rule(const Surface& surface);
  void spread(const Net& f);
  void sum(Net& u);

  int part_ = 0, parts_ = 1;
  std::vector<int> everybody_, targets_;
  std::vector<Vec3> at_;                                 // their places
  surface::Symmetry symmetry_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> values_;  // R at the fundamental sites
  std::vector<int> row_;                                 // of each site, that of its fundamental one
  Eigen::VectorXd weights_;
  std::vector<double> node_[3], force_[3];
  std::optional<stokes::TreeSum> tree_;                  // where clusters are faster
  stokes::NearPoints near_;
  std::vector<double> entries_;                          // 11, 12, 13, 22, 23, 33 of K for each near point of each target
};

}  // namespace tanktread::coupling
