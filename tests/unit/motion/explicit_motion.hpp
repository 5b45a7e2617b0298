#pragma once
// Base of model motions for tests that have no stiffness and no volume constraint.

#include "system/dynamics.hpp"

namespace tanktread::motion {

/// A motion with a zero Jacobian. A model adds its velocity and its norm.
class ExplicitMotion : public coupling::Dynamics {
 public:
  void freeze(const Net&) override {}
  void linearise(const Net&) override {}
  Net solve(double, const Net& r, double, const coupling::Secants&) override { return r; }
  Net jacobian_error(const Net& change, const Net&, double) override { return 0 * change; }
  void restore_constraints(Net&) override {}
};

}  // namespace tanktread::motion
