#include "motion/fixed_point_error.hpp"

#include <algorithm>
#include <limits>

#include <Eigen/QR>

namespace tanktread::motion {

Net FixedPointError::operator()(const Net& x, const Net& f) {
  // A column of dF (4.32) is ignored if its component orthogonal to the other columns is shorter than this fraction of the column.
  constexpr double independent = 1e-6;
  Eigen::MatrixXd dx(x.size(), static_cast<Eigen::Index>(before_.size())), df(x.size(), dx.cols());
  for (Eigen::Index j = 0; j < dx.cols(); ++j) {
    const auto& [other_x, other_f] = before_[static_cast<std::size_t>(j)];
    const double size = std::max((f - other_f).norm(), std::numeric_limits<double>::min());
    dx.col(j) = (x - other_x).reshaped() / size, df.col(j) = (f - other_f).reshaped() / size;
  }
  Net error = -f;
  if (dx.cols() > 0) {
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors;
    factors.setThreshold(independent);
    const Eigen::VectorXd c = factors.compute(df).solve(f.reshaped().matrix());
    error += ((dx + df) * c).reshaped(x.rows(), 3);
  }
  before_.emplace_back(x, f);
  if (static_cast<int>(before_.size()) > most_) before_.pop_front();
  return error;
}

}  // namespace tanktread::motion
