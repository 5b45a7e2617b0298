#pragma once
// What a rigid body does.

#include "base/types.hpp"

namespace tanktread::coupling {

/// v = U + Omega x (x - centre)
struct RigidMotion {
  Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
};

/// U + Omega x (x - centre) at points, a row each; also its control values from a control net, exactly, for the basis sums to one.
Net rigid_velocity(const Net& x, const RigidMotion& motion, const Vec3& centre);

}  // namespace tanktread::coupling
