#pragma once
// A capsule or drop and what its surface carries along, as time integrators see them.

#include "coupling/capsule.hpp"
#include "membrane/carried.hpp"

namespace tanktread::coupling {

/// The motion of a net y: the rows of the control points, and behind them, three a row, the q of what the surface carries along, which drives the
/// fluid and goes with it. For explicit schemes: there is no Jacobian. Calls are collective, as the capsule's are; every rank has all of q.
class CarriedMotion : public Dynamics {
 public:
  /// Both must outlive it.
  CarriedMotion(Capsule& capsule, membrane::Carried& carried) : capsule_(capsule), carried_(carried) {}

  Net start(const Net& shape) const;              ///< y of a run that begins with this shape
  Net shape(const Net& y) const;                  ///< the capsule's rows
  Net with_shape(const Net& y, const Net& shape) const;
  Eigen::VectorXd content(const Net& y) const;    ///< q

  /// Takes y to the capsule and what it carries, so that what is asked of either is of y.
  void place(const Net& y);

  Net velocity(const Net& y) override;
  void at(double time, double start) override { capsule_.at(time, start); }
  double next_kink(double time) const override { return capsule_.next_kink(time); }
  void restore_volume(Net& y) override;
  double norm(const Net& displacement) const override;  ///< the larger one of the capsule's and the root mean square of what q changes by

  void freeze(const Net&) override { refuse(); }
  void linearise(const Net&) override { refuse(); }
  Net solve(double, const Net&, double, const Secants&) override { refuse(); }
  Net missed(const Net&, const Net&) override { refuse(); }

 private:
  [[noreturn]] static void refuse();
  Eigen::Index points(const Net& y) const { return y.rows() - (carried_.size() + 2) / 3; }

  Capsule& capsule_;
  membrane::Carried& carried_;
};

}  // namespace tanktread::coupling
