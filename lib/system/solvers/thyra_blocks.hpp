#pragma once
// Thyra vectors of blocks of unknowns, and Thyra operators from functions on plain arrays.

#include <utility>

#include <Thyra_LinearOpBase.hpp>
#include <Thyra_LinearOpWithSolveFactoryBase.hpp>
#include <Thyra_VectorBase.hpp>

#include "system/solvers/krylov.hpp"

namespace tanktread::coupling {

using Space = Thyra::VectorSpaceBase<double>;
using ThyraVector = Thyra::VectorBase<double>;

/// Returns the product of the vector spaces of all blocks; for a single block, the vector space of this block. Every rank holds all rows of each
/// block, because operators need all rows. Dot products then need no communication, and iteration counts cannot differ between ranks. The vectors are
/// Thyra's own, because Tpetra vectors would add maps and imports that are not needed and that take a fifth of the time of a run of 0.1 s.
Teuchos::RCP<const Space> vector_space(const Blocks& blocks);

/// Returns the entries of all blocks of a vector, one block after another.
Eigen::VectorXd numbers_of(const ThyraVector& vector);

/// Sets the entries of a vector, on all ranks, to the values that `numbers` has on the first rank.
void set(const Teuchos::RCP<ThyraVector>& vector, const Eigen::VectorXd& numbers);

/// Returns a vector of `space` with the entries `numbers` of the first rank.
Teuchos::RCP<ThyraVector> vector_of(const Teuchos::RCP<const Space>& space, const Eigen::VectorXd& numbers);

/// Linear operator on a vector of all blocks, defined by a function. A zero vector is mapped to zero without calling the function. Every rank uses
/// the result of the first rank. Before each product, all ranks answer a stop request (stop_together).
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

/// A factory of Belos solvers with the same parameters as in the class Krylov. `flexible`: true if the solver is flexible GMRES, which always needs a
/// preconditioner, at least the identity.
struct BelosFactory {
  Teuchos::RCP<Thyra::LinearOpWithSolveFactoryBase<double>> factory;
  bool flexible = false;
};
BelosFactory belos_factory(const IterativeOptions& options);

}  // namespace tanktread::coupling
