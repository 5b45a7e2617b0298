#pragma once
// The preconditioner chosen by the deck for a linear system.

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "system/solvers/krylov.hpp"

namespace tanktread::coupling {

/// Preconditioner from the products y = A z of earlier solves, latest first, with orthonormal y: maps the part in the span of y by Z Y^T and the rest
/// by another preconditioner (2.24)
class RecycledProducts {
 public:
  /// Records a product of the current solve, which is used from the next solve on.
  void record(const Eigen::VectorXd& z, const Eigen::VectorXd& y) { present_.push_back({z, y}); }

  /// Ends the current solve.
  void refresh();

  /// Computes out = Z Y^T in + P (in - Y Y^T in), with `other` as P.
  void apply(const Eigen::VectorXd& in, const Apply& other, Eigen::Map<Eigen::VectorXd> out) const;

  double scale() const { return scale_; }

 private:
  struct Product {
    Eigen::VectorXd z, y;
  };

  void keep(Product product);

  static constexpr std::size_t most = 10;
  std::vector<Product> present_, kept_;
  double scale_ = 1;  // s that minimises |z - s y|: one over the size of the operator
};

/// Preconditioner `Solvers/<system>/preconditioner` of the deck, with its data from earlier solves.
class ChosenPreconditioner {
 public:
  explicit ChosenPreconditioner(std::string kind = "own") : kind_(std::move(kind)) {}

  /// Returns the system with this preconditioner. The result refers to `system` and to this object.
  LinearSystem join(const LinearSystem& system);

  void refresh() { recycled_.refresh(); }  ///< ends a solve
  void forget() { recycled_ = {}; }        ///< discards data of an earlier system

 private:
  std::string kind_;
  RecycledProducts recycled_;
};

}  // namespace tanktread::coupling
