#include "system/solvers/chosen_preconditioner.hpp"

#include <iterator>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace tanktread::coupling {

void RecycledProducts::refresh() {
  double zy = 0, yy = 0;
  for (const auto& [z, y] : present_) zy += z.dot(y), yy += y.squaredNorm();
  if (zy > 0) scale_ = zy / yy;
  std::vector<Product> all = std::move(present_);
  all.insert(all.end(), std::make_move_iterator(kept_.begin()), std::make_move_iterator(kept_.end()));
  present_.clear(), kept_.clear();
  for (Product& product : all)
    if (kept_.size() < most) keep(std::move(product));
}

void RecycledProducts::apply(const Eigen::VectorXd& in, const Apply& other, Eigen::Map<Eigen::VectorXd> out) const {
  Eigen::VectorXd rest = in, known = Eigen::VectorXd::Zero(in.size());
  for (const auto& [z, y] : kept_) {
    const double share = y.dot(in);
    rest -= share * y;
    known += share * z;
  }
  out = scale_ * rest;
  if (other) other(rest.data(), out.data());
  out += known;
}

/// Makes y orthogonal to the stored y by Gram-Schmidt orthogonalisation, done twice because of rounding, and stores the product unless y nearly
/// depends on the stored ones.
void RecycledProducts::keep(Product product) {
  const double size = product.y.norm();
  for (int twice = 0; twice < 2; ++twice)
    for (const auto& [z, y] : kept_) {
      const double share = y.dot(product.y);
      product.y -= share * y;
      product.z -= share * z;
    }
  const double rest = product.y.norm();
  if (rest > 0.3 * size) kept_.push_back({product.z / rest, product.y / rest});
}

LinearSystem ChosenPreconditioner::join(const LinearSystem& system) {
  LinearSystem result = system;
  if (kind_ == "none") result.precondition = {};
  if (kind_ == "none" || kind_ == "own") return result;
  const Eigen::Index n = std::accumulate(system.blocks.begin(), system.blocks.end(), Eigen::Index(0),
                                         [](Eigen::Index sum, const Block& block) { return sum + block.size(); });
  result.product = [this, &system, n](const double* in, double* out) {
    system.product(in, out);
    recycled_.record(Eigen::Map<const Eigen::VectorXd>(in, n), Eigen::Map<Eigen::VectorXd>(out, n));
  };
  if (kind_ != "recycled") throw std::logic_error("no preconditioner is called " + kind_);
  result.precondition = [this, &system, n](const double* in, double* out) {
    recycled_.apply(Eigen::Map<const Eigen::VectorXd>(in, n), system.precondition, {out, n});
  };
  return result;
}

}  // namespace tanktread::coupling
