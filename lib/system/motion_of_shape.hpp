#pragma once
// Motion of a drop's shape, with which its mesh moves: a translation, a rotation and a uniform stretch.

#include "base/types.hpp"

namespace tanktread::coupling {

/// State of a drop: at its control points the positions x, the volume gradient b = dV/dx and the fluid velocity v; at its collocation sites the
/// positions, normals and velocities. Rows: points or sites of this drop.
struct DropSamples {
  Net x, b, v;
  Net sites, normals, velocities;
};

/// Motion W (4.14) of a shape: W(x) = velocity + gradient (x - centre).
struct MotionOfShape {
  Vec3 centre, velocity;
  Mat3 gradient;

  Vec3 at(const Vec3& x) const { return velocity + gradient * (x - centre); }
};

/// Motion W (4.14) that a mesh shares with the shape of its drop: a translation, in addition the rotation of the shape, or in addition its stretch.
enum class SharedMotion { translation, rigid, stretching };

/// Returns the motion W (4.14) of the shape of a drop, which is linear in v: the mean velocity of its fluid, and depending on `shared` the rotation
/// of its shape and the rate of stretch E (4.36) without volume change. On a sphere the rotation is 0, on a steady shape also E.
MotionOfShape motion_of_shape(const DropSamples& drop, SharedMotion shared);

}  // namespace tanktread::coupling
