#pragma once
// What a rigid body does.

#include "base/types.hpp"

namespace tanktread::coupling {

/// v = U + Omega x (x - centre)
struct RigidMotion {
  Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
};

/// The unit motion k: a translation along x1, x2, x3, a rotation about them.
inline RigidMotion unit_motion(int k) {
  RigidMotion unit;
  (k < 3 ? unit.velocity : unit.angular_velocity)[k % 3] = 1;
  return unit;
}

/// U + Omega x (x - centre) at points, a row each; also its control values from a control net, exactly, for the basis sums to one.
Net rigid_velocity(const Net& x, const RigidMotion& motion, const Vec3& centre);

}  // namespace tanktread::coupling
