#pragma once
// Single layer of the Jacobian, frozen at an earlier shape: trapezoidal rule on the control points, corrected near the target.

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

/// The single layer A of (4.2) by the trapezoidal rule at the collocation sites x_B, corrected for control points near the target:
///
///   (A f)_i = sum_B G(x_B, x_i) w_B (R f)_B / 8 pi  +  sum over near C of K_iC f_C,   w_B = int N_B dGamma_0                    (4.11)
///   K_iC = A_iC - sum_B G(x_B, x_i) w_B R_BC / 8 pi
///
/// G is the Stokeslet, R the collocation matrix, N_B a basis function and dGamma_0 the unstressed area element. In the sums over B, the node at the
/// target itself is omitted. Only the near blocks K_iC are stored, about thirty per target. The first sum is evaluated in every product, on large
/// surfaces by a treecode. Double precision is used, because rounding errors of single precision would grow from step to step: runs with and without
/// symmetry, which agree to 1e-8 in the deformation D, would then differ by more.
///
/// The error of this operator is the error of the trapezoidal rule for nodes a few elements away. This error slows the quasi-Newton iteration
/// slightly and does not affect accuracy.
class NodalOperator {
 public:
  struct Surface {
    Net sites;                          ///< x_B, collocation sites
    Eigen::SparseMatrix<double> values;  ///< R, collocation matrix, shape (N, N)
    Eigen::VectorXd weights;             ///< w_B, weights of the trapezoidal rule
    Eigen::VectorXd areas;               ///< current area of each control point. Control point C is near the target x_i if the distance |x_C - x_i|
                                         ///< is below reach sqrt(areas[C])
    surface::Symmetry symmetry;          ///< symmetry of the surface and the densities; Symmetry() if there is none
  };

  /// Function that computes the 3 x 3 blocks A_iC of the single layer for control points C near target i (Layer::assemble).
  using Assemble = std::function<void(std::span<const int> targets, const stokes::NearPoints& near, std::vector<double>& entries)>;

  /// Assembles the operator at the rank-owned `targets`. `reach`: see Surface::areas. `far_sum`: method for the sums over all nodes, as in
  /// quadrature::Options.
  void assemble(const std::vector<int>& targets, const Surface& surface, double reach, const std::string& far_sum, const Assemble& assemble);

  /// Divides the work of the treecode among the ranks, in `parts` equal parts. This rank computes the part with the index `part`. `everybody`: the
  /// targets of all ranks.
  void share(int part, int parts, std::vector<int> everybody);

  /// Computes the rows of u = A f at the rank-owned targets; other rows are unchanged. If ranks share the sums, computes this rank's contribution to
  /// all rows.
  void apply(const Net& f, Net& u);

  /// Returns whether each rank computes only a part of every sum. A f is then the sum, over all ranks, of the results u of `apply`.
  bool shared() const { return tree_ && parts_ > 1; }

 private:
  void find_near(const Surface& surface, double reach);
  void subtract_rule(const Surface& surface);
  void spread(const Net& f);
  void sum(Net& u);

  int part_ = 0, parts_ = 1;
  std::vector<int> everybody_, targets_;
  std::vector<Vec3> at_;                                 // positions of the targets
  surface::Symmetry symmetry_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> values_;  // R at the fundamental sites
  std::vector<int> row_;                                 // for each site, the index in symmetry_.fundamental() of the fundamental site of its orbit
  Eigen::VectorXd weights_;
  std::vector<double> node_[3], force_[3];
  std::optional<stokes::TreeSum> tree_;                  // treecode; set if it is faster than the direct sum
  stokes::NearPoints near_;
  std::vector<double> entries_;                          // entries 11, 12, 13, 22, 23, 33 of the near-field blocks K_iC (4.11) of each target
};

}  // namespace tanktread::coupling
