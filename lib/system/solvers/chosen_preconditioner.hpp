#pragma once
// The preconditioner that a deck chooses for a linear system.

#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "system/solvers/krylov.hpp"

namespace tanktread::coupling {

/// Products y = A z of the solves before, the latest first, y made orthonormal: as a preconditioner Y^T and then Z, and another for the rest   (2.24)
class RecycledProducts {
 public:
  /// A product of the present solve, which counts from the next one on.
  void record(const Eigen::VectorXd& z, const Eigen::VectorXd& y) { present_.push_back({z, y}); }

  /// Ends the present solve.
  void refresh();

  /// out = Z Y^T in + P (in - Y Y^T in)
  void apply(const Eigen::VectorXd& in, const Apply& other, Eigen::Map<Eigen::VectorXd> out) const;

  double scale() const { return scale_; }

 private:
  struct Product {
    Eigen::VectorXd z, y;
  };

  void keep(Product product);

  static constexpr std::size_t most = 10;
  std::vector<Product> present_, kept_;
  double scale_ = 1;  // s of the least |z - s y|: one over the size of the operator
};

/// `Solvers/<system>/preconditioner` of the deck, with what it remembers from solve to solve.
class ChosenPreconditioner {
 public:
  explicit ChosenPreconditioner(std::string kind = "own") : kind_(std::move(kind)) {}

  /// The system with this preconditioner, which refers to both.
  LinearSystem join(const LinearSystem& system);

  void refresh() { recycled_.refresh(); }  ///< ends a solve
  void forget() { recycled_ = {}; }        ///< what was of another system

 private:
  std::string kind_;
  RecycledProducts recycled_;
};

}  // namespace tanktread::coupling
