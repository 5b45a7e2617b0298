#include "system/solvers/vectors.hpp"

#include <cassert>

#include <Kokkos_Core.hpp>
#include <Teuchos_DefaultSerialComm.hpp>

#include "system/parallel/agreement.hpp"
#include "system/parallel/stop_together.hpp"

namespace tanktread::coupling {

Teuchos::RCP<const VectorMap> replicated(Eigen::Index n) {
  if (!Kokkos::is_initialized()) Kokkos::initialize();  // serial tests
  return Teuchos::rcp(new VectorMap(static_cast<std::size_t>(n), 0, Teuchos::rcp(new Teuchos::SerialComm<int>), Tpetra::LocallyReplicated));
}

Eigen::Map<const Eigen::VectorXd> column(const Vectors& vectors, std::size_t c) {
  return {vectors.getData(c).getRawPtr(), static_cast<Eigen::Index>(vectors.getLocalLength())};
}

void set_column(Vectors& vectors, std::size_t c, const Eigen::VectorXd& numbers) {
  assert(numbers.size() == static_cast<Eigen::Index>(vectors.getLocalLength()));
  set_together(vectors.getDataNonConst(c).getRawPtr(), numbers);
}

void set_together(double* to, const Eigen::VectorXd& numbers) {
  Eigen::Map<Eigen::VectorXd>(to, numbers.size()) = numbers;
  take_first({to, static_cast<std::size_t>(numbers.size())});
}

void apply_together(const Apply& function, Eigen::Index n, const double* in, double* out) {
  Eigen::Map<Eigen::VectorXd> image(out, n);
  if (Eigen::Map<const Eigen::VectorXd>(in, n).isZero(0)) {
    image.setZero();
    return;
  }
  stop_together();
  function(in, out);
  take_first({out, static_cast<std::size_t>(n)});
}

void FunctionOperator::apply(const Vectors& x, Vectors& y, Teuchos::ETransp, double alpha, double beta) const {
  Eigen::VectorXd image(static_cast<Eigen::Index>(x.getLocalLength()));
  for (std::size_t c = 0; c < x.getNumVectors(); ++c) {
    if (function)
      apply_together(function, image.size(), column(x, c).data(), image.data());
    else
      image = column(x, c);
    Eigen::Map<Eigen::VectorXd> result(y.getDataNonConst(c).getRawPtr(), image.size());
    if (beta == 0)
      result = alpha * image;
    else
      result = alpha * image + beta * result;
  }
}

}  // namespace tanktread::coupling
