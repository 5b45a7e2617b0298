#pragma once
// Blocks of unknowns as vectors of Thyra, and functions on plain arrays as its operators.

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <Thyra_LinearOpBase.hpp>
#include <Thyra_LinearOpWithSolveFactoryBase.hpp>
#include <Thyra_VectorBase.hpp>

#include "system/solvers/krylov.hpp"

namespace tanktread::coupling {

using Space = Thyra::VectorSpaceBase<double>;
using ThyraVector = Thyra::VectorBase<double>;

/// The product of a space a block; of a single block that alone. Every rank holds all rows of each: operators need them all, dot products need no
/// message, and an iteration count cannot differ between ranks. So they are Thyra's own vectors: what Tpetra's have beyond them (maps, imports) would
/// not be used, and costs a fifth of a run of a tenth of a second.
Teuchos::RCP<const Space> vector_space(const Blocks& blocks);

/// The blocks of a vector, one after another.
Eigen::VectorXd numbers_of(const ThyraVector& vector);

/// A vector of that space with these numbers, which are the first rank's.
Teuchos::RCP<ThyraVector> vector_of(const Teuchos::RCP<const Space>& space, Eigen::VectorXd numbers);

/// A linear function on all blocks, one after another, as an operator. Zeros are known to give zeros. What it gives is the first rank's.
class FunctionOperator : public Thyra::LinearOpBase<double> {
 public:
  explicit FunctionOperator(Teuchos::RCP<const Space> space) : space_(std::move(space)) {}

  Apply function;

  Teuchos::RCP<const Space> range() const override { return space_; }
  Teuchos::RCP<const Space> domain() const override { return space_; }

 private:
  bool opSupportedImpl(Thyra::EOpTransp transpose) const override { return transpose == Thyra::NOTRANS; }
  void applyImpl(Thyra::EOpTransp transpose, const Thyra::MultiVectorBase<double>& x, const Teuchos::Ptr<Thyra::MultiVectorBase<double>>& y,
                 double alpha, double beta) const override;

  Teuchos::RCP<const Space> space_;
};

/// A solver of Belos, made as Krylov is. The flexible GMRES needs a preconditioner, if only the identity.
struct BelosFactory {
  Teuchos::RCP<Thyra::LinearOpWithSolveFactoryBase<double>> factory;
  bool flexible = false;
};
BelosFactory belos_factory(const IterativeOptions& options);

}  // namespace tanktread::coupling
