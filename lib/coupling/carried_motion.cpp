#include "coupling/carried_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace tanktread::coupling {

namespace {

/// A net of a capsule's rows and q behind them.
Net stacked(const Net& shape, const Eigen::VectorXd& q) {
  Net y = Net::Zero(shape.rows() + (q.size() + 2) / 3, 3);
  y.topRows(shape.rows()) = shape;
  std::copy(q.begin(), q.end(), y.data() + shape.size());
  return y;
}

}  // namespace

Net CarriedMotion::start(const Net& shape) const { return stacked(shape, carried_.start(shape)); }
Net CarriedMotion::shape(const Net& y) const { return y.topRows(points(y)); }
Net CarriedMotion::with_shape(const Net& y, const Net& shape) const { return stacked(shape, content(y)); }
Eigen::VectorXd CarriedMotion::content(const Net& y) const { return Eigen::Map<const Eigen::VectorXd>(y.data() + 3 * points(y), carried_.size()); }

void CarriedMotion::place(const Net& y) {
  carried_.place(shape(y), content(y));
  capsule_.press(-carried_.load());
}

Net CarriedMotion::velocity(const Net& y) {
  if (!y.allFinite()) return Net::Constant(y.rows(), 3, std::numeric_limits<double>::quiet_NaN());
  place(y);
  const Net x = shape(y), u = capsule_.velocity(x);
  if (!u.allFinite()) return Net::Constant(y.rows(), 3, std::numeric_limits<double>::quiet_NaN());
  return stacked(u, carried_.rate(capsule_.fluid_velocity(x) - u));
}

void CarriedMotion::restore_volume(Net& y) {
  Net x = shape(y);
  capsule_.restore_volume(x);
  y.topRows(x.rows()) = x;
}

double CarriedMotion::norm(const Net& displacement) const {
  const double moved = capsule_.norm(shape(displacement)), changed = content(displacement).norm() / std::sqrt(static_cast<double>(carried_.size()));
  return changed > moved ? changed : moved;  // what is not a number stays so
}

void CarriedMotion::refuse() { throw std::logic_error("what a surface carries along is in no Jacobian"); }

}  // namespace tanktread::coupling
