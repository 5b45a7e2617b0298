#pragma once
// Rigid-body motion, and the forces that a body exerts.

#include "base/types.hpp"

namespace tanktread::coupling {

/// Rigid motion v = U + Omega x (x - centre).
struct RigidMotion {
  Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
};

/// Motion of a rigid body, and integrals of its force density f on the fluid.
struct SolvedBody {
  RigidMotion motion;
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  ///< force and torque (about the centre) of the body on the fluid
  Mat3 moment = Mat3::Zero();                        ///< first moment int f r dG, with the position r from the centre

  /// Returns the symmetric, traceless part of `moment`.
  Mat3 stresslet() const { return (moment + moment.transpose()) / 2 - moment.trace() / 3 * Mat3::Identity(); }
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
