#pragma once
// The single layer that the Jacobian keeps frozen, by one node a control point and corrections for near ones.

#include <functional>
#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "stokes/single_layer.hpp"
#include "surface/symmetry.hpp"

namespace tanktread::coupling {

/// A of (4.2) as the trapezoidal rule at the collocation sites x_B, corrected where control points are near the target:
///
///   (A f)_i = sum_B G(x_B, x_i) w_B (R f)_B / 8 pi  +  sum over near C of K_iC f_C,   w_B = int N_B dG0                         (4.11)
///   K_iC = A_iC - sum_B G(x_B, x_i) w_B R_BC / 8 pi
///
/// A node at the target counts as nothing. The sum is taken on the fly, in double precision: the noise of single precision would grow, from step to
/// step, to what tells symmetric runs from whole ones (1e-8 of D). It needs no memory, and what it leaves out of A is
/// the rule's error at a distance of a few elements, which costs a quasi-Newton iteration some contraction and no accuracy.
class NodalOperator {
 public:
  struct Surface {
    Net sites;                          ///< x_B
    Eigen::SparseMatrix<double> values;  ///< R, shape (N, N)
    Eigen::VectorXd weights;             ///< w_B
    Eigen::VectorXd areas;               ///< present ones: a control point C is near where |x_C - x_i| < reach sqrt(area_C)
    surface::Symmetry symmetry;          ///< of surface and densities; of no points: none
  };

  using Assemble = std::function<void(std::span<const int> targets, stokes::Rows<double>& rows)>;

  /// `assemble(targets, rows)` fills three rows of the exact A a target, for a few targets at a time.
  void assemble(const std::vector<int>& targets, const Surface& surface, double reach, const Assemble& assemble);

  /// Rows of the own targets of u = A f; other rows are untouched.
  void apply(const Net& f, Net& u) const;

  bool empty() const { return targets_.empty(); }

 private:
  struct Block {
    int point;
    double a[6];  // entries 11, 12, 13, 22, 23, 33
  };
  void spread(const Net& f) const;
  void correct(int target, const Surface& surface, double reach, const stokes::Rows<double>& rows, Eigen::Index row);

  std::vector<int> targets_;
  surface::Symmetry symmetry_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> values_;  // R at the fundamental sites
  std::vector<int> row_;                                 // of each site, that of its fundamental one
  Eigen::VectorXd weights_;
  std::vector<double> node_[3];  // padded to whole tiles
  mutable std::vector<double> force_[3];
  std::vector<Block> blocks_;
  std::vector<std::size_t> first_block_;
};

/// Targets that share a pass over the nodes, and nodes worked on together.
constexpr int nodal_block = 4, nodal_tile = 8;

/// u[3 l + c] = sum_k G(x_k, x0_l) f_k for nodal_block targets x0[3 l + c]; n is a multiple of nodal_tile. Each target's sum does not depend on the
/// other targets. A node at the target counts as nothing.
void nodal_sum(int n, const double* const (&node)[3], const double* const (&force)[3], const double* x0, double* u);

}  // namespace tanktread::coupling
