#pragma once
// The preconditioner chosen by the deck for a linear system.

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "system/solvers/krylov.hpp"

namespace tanktread::coupling {

/// Preconditioner from the products y = A z of earlier solves, latest first. The columns of Z are the stored vectors z. The columns of Y are the
/// stored vectors y, which are orthonormal. Applies Z Y^T to the part of a vector in the span of Y, and another preconditioner to the remainder
/// (2.24).
class RecycledProducts {
 public:
  /// Records a product y = A z of the current solve. apply() uses this product from the next solve on.
  void record(const Eigen::VectorXd& z, const Eigen::VectorXd& y) { present_.push_back({z, y}); }

  /// Ends the current solve: later calls of apply() also use the products recorded in this solve.
  void refresh();

  /// Computes out = Z Y^T in + P (in - Y Y^T in) (2.24). The columns of Z and Y are the stored z and y = A z; P is the preconditioner `other`.
  void apply(const Eigen::VectorXd& in, const Apply& other, Eigen::Map<Eigen::VectorXd> out) const;

 private:
  struct Product {
    Eigen::VectorXd z, y;
  };

  void keep(Product product);

  static constexpr std::size_t most = 10;
  std::vector<Product> present_, kept_;
  double scale_ = 1;  // estimate of 1/|A|: the factor s that minimises the sum of |z - s y|^2 over the products y = A z of the last solve
};

/// Preconditioner `Solvers/<system>/preconditioner` of the deck, with its data from earlier solves.
class ChosenPreconditioner {
 public:
  explicit ChosenPreconditioner(std::string kind = "own") : kind_(std::move(kind)) {}

  /// Returns `system` with the chosen preconditioner. The result keeps references to `system` and to this object.
  LinearSystem join(const LinearSystem& system);

  /// Returns whether the result of join() contains the preconditioner of `system` unchanged.
  bool keeps_own() const { return kind_ == "own"; }

  void refresh() { recycled_.refresh(); }  ///< ends a solve
  void forget() { recycled_ = {}; }        ///< discards the products y = A z recorded in earlier solves

 private:
  std::string kind_;
  RecycledProducts recycled_;
};

}  // namespace tanktread::coupling
