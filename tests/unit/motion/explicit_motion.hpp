#pragma once
// Base of model motions for tests that have no stiffness and no volume constraint.

#include "system/dynamics.hpp"

namespace tanktread::motion {

/// A motion with a zero Jacobian. A model adds its velocity and its norm.
class ExplicitMotion : public coupling::Dynamics {
 public:
  Net jacobian_error(const Net& change, const Net&, double) override { return 0 * change; }
  void restore_constraints(Net&) override {}
};

}  // namespace tanktread::motion
