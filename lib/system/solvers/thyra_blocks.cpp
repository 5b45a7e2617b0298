#include "system/solvers/thyra_blocks.hpp"

#include <cassert>

#include <Teuchos_DefaultSerialComm.hpp>
#include <Thyra_DefaultProductVectorSpace.hpp>
#include <Thyra_DefaultSpmdVectorSpace.hpp>
#include <Thyra_DetachedVectorView.hpp>

#include "system/parallel/agreement.hpp"
#include "system/parallel/stop_together.hpp"

namespace tanktread::coupling {

Teuchos::RCP<const Space> vector_space(const Blocks& blocks) {
  const auto alone = Teuchos::rcp(new Teuchos::SerialComm<Thyra::Ordinal>);
  Teuchos::Array<Teuchos::RCP<const Space>> spaces;
  for (const UnknownBlock& block : blocks) spaces.push_back(Thyra::defaultSpmdVectorSpace<double>(alone, block.size, block.size));
  if (spaces.size() == 1) return spaces[0];
  return Thyra::productVectorSpace<double>(spaces());
}

Eigen::VectorXd numbers_of(const ThyraVector& vector) {
  const Thyra::ConstDetachedVectorView<double> view(vector);
  return Eigen::Map<const Eigen::VectorXd>(view.values(), view.subDim());
}

void set(const Teuchos::RCP<ThyraVector>& vector, const Eigen::VectorXd& numbers) {
  const Thyra::DetachedVectorView<double> view(vector);
  assert(view.subDim() == numbers.size());
  Eigen::Map<Eigen::VectorXd>(view.values(), numbers.size()) = numbers;
  take_first({view.values(), static_cast<std::size_t>(numbers.size())});
}

Teuchos::RCP<ThyraVector> vector_of(const Teuchos::RCP<const Space>& space, const Eigen::VectorXd& numbers) {
  const Teuchos::RCP<ThyraVector> vector = Thyra::createMember(space);
  set(vector, numbers);
  return vector;
}

void FunctionOperator::applyImpl(Thyra::EOpTransp, const Thyra::MultiVectorBase<double>& x, const Teuchos::Ptr<Thyra::MultiVectorBase<double>>& y,
                                 double alpha, double beta) const {
  Eigen::VectorXd image(space_->dim());
  for (Thyra::Ordinal c = 0; c < x.domain()->dim(); ++c) {
    const Thyra::ConstDetachedVectorView<double> in(x.col(c));
    const Thyra::DetachedVectorView<double> out(y->col(c));
    if (Eigen::Map<const Eigen::VectorXd>(in.values(), image.size()).isZero(0)) {
      image.setZero();
    } else {
      stop_together();
      function(in.values(), image.data());
      take_first({image.data(), static_cast<std::size_t>(image.size())});
    }
    Eigen::Map<Eigen::VectorXd> result(out.values(), image.size());
    if (beta == 0)
      result = alpha * image;
    else
      result = alpha * image + beta * result;
  }
}

}  // namespace tanktread::coupling
