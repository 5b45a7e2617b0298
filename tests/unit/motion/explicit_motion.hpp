#pragma once
// What models of a motion have in common if nothing of them is stiff and no volume is kept.

#include "system/dynamics.hpp"

namespace tanktread::motion {

/// A motion whose Jacobian is taken for 0. A model adds its velocity and its norm.
class ExplicitMotion : public coupling::Dynamics {
 public:
  void freeze(const Net&) override {}
  void linearise(const Net&) override {}
  Net solve(double, const Net& r, double, const coupling::Secants&) override { return r; }
  Net missed(const Net& dv, const Net&) override { return 0 * dv; }
  void restore_volume(Net&) override {}
};

}  // namespace tanktread::motion
