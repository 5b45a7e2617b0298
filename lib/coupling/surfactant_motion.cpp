#include "coupling/surfactant_motion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace tanktread::coupling {

namespace {

/// A net of a drop's rows and q behind them.
Net stacked(const Net& shape, const Eigen::VectorXd& q) {
  Net y = Net::Zero(shape.rows() + (q.size() + 2) / 3, 3);
  y.topRows(shape.rows()) = shape;
  std::copy(q.begin(), q.end(), y.data() + shape.size());
  return y;
}

}  // namespace

Net SurfactantMotion::start(const Net& shape) const { return stacked(shape, Eigen::VectorXd::Ones(points())); }
Net SurfactantMotion::shape(const Net& y) const { return y.topRows(points()); }
Net SurfactantMotion::with_shape(const Net& y, const Net& shape) const { return stacked(shape, content(y)); }
Eigen::VectorXd SurfactantMotion::content(const Net& y) const {
  return Eigen::Map<const Eigen::VectorXd>(y.data() + 3 * points(), points());
}

void SurfactantMotion::place(const Net& y) {
  surfactant_.place(shape(y), content(y));
  drop_.press(-surfactant_.load());
}

Net SurfactantMotion::velocity(const Net& y) {
  if (!y.allFinite()) return Net::Constant(y.rows(), 3, std::numeric_limits<double>::quiet_NaN());
  place(y);
  const Net x = shape(y), u = drop_.velocity(x);
  if (!u.allFinite()) return Net::Constant(y.rows(), 3, std::numeric_limits<double>::quiet_NaN());
  return stacked(u, surfactant_.rate(drop_.fluid_velocity(x) - u));
}

void SurfactantMotion::restore_volume(Net& y) {
  Net x = shape(y);
  drop_.restore_volume(x);
  y.topRows(points()) = x;
}

double SurfactantMotion::norm(const Net& displacement) const {
  const double moved = drop_.norm(shape(displacement)), changed = content(displacement).norm() / std::sqrt(static_cast<double>(points()));
  return changed > moved ? changed : moved;  // what is not a number stays so
}

void SurfactantMotion::refuse() { throw std::logic_error("a drop with surfactant has no Jacobian"); }

}  // namespace tanktread::coupling
