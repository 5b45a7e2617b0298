#pragma once
// A drop with surfactant as time integrators see it.

#include "coupling/capsule.hpp"
#include "membrane/surfactant.hpp"

namespace tanktread::coupling {

/// The motion of a net y: the rows of the drop's control points, and behind them, three a row, the q of its surfactant (3.17). Its tension drives the
/// fluid, and the fluid carries it along. For explicit schemes: there is no Jacobian. Calls are collective, as the drop's are; every rank has all of
/// the surfactant.
class SurfactantMotion : public Dynamics {
 public:
  /// Both must outlive it.
  SurfactantMotion(Capsule& drop, membrane::Surfactant& surfactant) : drop_(drop), surfactant_(surfactant) {}

  Net start(const Net& shape) const;              ///< y of an even concentration
  Net shape(const Net& y) const;                  ///< the drop's rows
  Net with_shape(const Net& y, const Net& shape) const;
  Eigen::VectorXd content(const Net& y) const;    ///< q

  /// Takes y to drop and surfactant, so that what is asked of either is of y.
  void place(const Net& y);

  Net velocity(const Net& y) override;
  void at(double time, double start) override { drop_.at(time, start); }
  double next_kink(double time) const override { return drop_.next_kink(time); }
  void restore_volume(Net& y) override;
  double norm(const Net& displacement) const override;  ///< the larger one of the drop's and the root mean square of what q changes by

  void freeze(const Net&) override { refuse(); }
  void linearise(const Net&) override { refuse(); }
  Net solve(double, const Net&, double, const Secants&) override { refuse(); }
  Net missed(const Net&, const Net&) override { refuse(); }

 private:
  [[noreturn]] static void refuse();
  Eigen::Index points() const { return surfactant_.size(); }

  Capsule& drop_;
  membrane::Surfactant& surfactant_;
};

}  // namespace tanktread::coupling
