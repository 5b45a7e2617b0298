#pragma once
// Rigid-body motion.

#include "base/types.hpp"

namespace tanktread::coupling {

/// Rigid motion v = U + Omega x (x - centre).
struct RigidMotion {
  Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
};

/// Returns the unit motion k: translations along x1, x2, x3, then rotations about them.
inline RigidMotion unit_motion(int k) {
  RigidMotion unit;
  (k < 3 ? unit.velocity : unit.angular_velocity)[k % 3] = 1;
  return unit;
}

/// Returns U + Omega x (x - centre) at points, one row each. For a control net it returns exact control values, because the basis sums to one.
Net rigid_velocity(const Net& x, const RigidMotion& motion, const Vec3& centre);

}  // namespace tanktread::coupling
