#pragma once
// Rigid-body motion, and the forces that a body exerts.

#include "base/types.hpp"

namespace tanktread::coupling {

/// Rigid motion v = U + Omega x (x - centre).
struct RigidMotion {
  Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
};

/// Returns the stresslet of a force density with the first moment `moment`: the symmetric, traceless part of `moment`.
inline Mat3 stresslet(const Mat3& moment) { return (moment + moment.transpose()) / 2 - moment.trace() / 3 * Mat3::Identity(); }

/// Motion of a rigid body, and integrals of its force density f on the fluid.
struct SolvedBody {
  RigidMotion motion;
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();  ///< force and torque (about the centre) of the body on the fluid
  Mat3 moment = Mat3::Zero();                        ///< first moment int f_i r_j dGamma, with the position r from the centre

  Mat3 stresslet() const { return coupling::stresslet(moment); }
};

/// Returns the unit motion k: translations along x1, x2, x3 (k = 0, 1, 2), rotations about these axes (k = 3, 4, 5).
inline RigidMotion unit_motion(int k) {
  RigidMotion unit;
  (k < 3 ? unit.velocity : unit.angular_velocity)[k % 3] = 1;
  return unit;
}

/// Returns U + Omega x (x - centre) at the points x, one row per point. If x is a control net, the result is the exact control net of this velocity,
/// because the basis functions sum to one.
inline Net rigid_velocity(const Net& x, const RigidMotion& motion, const Vec3& centre) {
  Net u(x.rows(), 3);
  for (Eigen::Index a = 0; a < u.rows(); ++a)
    u.row(a) = (motion.velocity + motion.angular_velocity.cross(x.row(a).transpose() - centre)).transpose();
  return u;
}

}  // namespace tanktread::coupling
