#pragma once
// Tpetra vectors of numbers that every rank holds, and Tpetra operators from functions on plain arrays.

#include <cstddef>
#include <utility>

#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>
#include <Tpetra_Operator.hpp>

#include "system/solvers/krylov.hpp"

namespace tanktread::coupling {

using VectorMap = Tpetra::Map<>;
using Vectors = Tpetra::MultiVector<>;
using Operator = Tpetra::Operator<>;

/// Returns the locally replicated map of n numbers: every rank holds all of them, because operators need all. Dot products then need no
/// communication, and iteration counts cannot differ between ranks.
Teuchos::RCP<const VectorMap> replicated(Eigen::Index n);

/// Returns the numbers of column c of `vectors`, shape (n).
Eigen::Map<const Eigen::VectorXd> column(const Vectors& vectors, std::size_t c = 0);

/// Sets column c of `vectors`, on all ranks, to the values that `numbers` has on the first rank.
void set_column(Vectors& vectors, std::size_t c, const Eigen::VectorXd& numbers);

/// Linear operator defined by a function. A zero vector is mapped to zero without calling the function. Every rank uses the result of the first
/// rank. Before each product, all ranks answer a stop request (stop_together).
class FunctionOperator : public Operator {
 public:
  explicit FunctionOperator(Teuchos::RCP<const VectorMap> map, Apply of = {}) : function(std::move(of)), map_(std::move(map)) {}

  Apply function;  ///< identity if empty

  Teuchos::RCP<const VectorMap> getDomainMap() const override { return map_; }
  Teuchos::RCP<const VectorMap> getRangeMap() const override { return map_; }
  void apply(const Vectors& x, Vectors& y, Teuchos::ETransp transposed, double alpha, double beta) const override;

 private:
  Teuchos::RCP<const VectorMap> map_;
};

/// Sets the numbers at `to`, on all ranks, to those of the first rank.
void set_together(double* to, const Eigen::VectorXd& numbers);

/// Calls `function`, unless the n numbers `in` are all 0 and so the results, and takes the results of the first rank. Before, all ranks answer a
/// stop request.
void apply_together(const Apply& function, Eigen::Index n, const double* in, double* out);

}  // namespace tanktread::coupling
