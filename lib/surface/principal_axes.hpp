#pragma once
// The axes of inertia of a closed surface.

#include "base/types.hpp"
#include "surface/geometry.hpp"

namespace tanktread::surface {

/// Semi-axes of the ellipsoid with the same second moments (6.1).
struct PrincipalAxes {
  Vec3 lengths = Vec3::Zero();     ///< the longest first
  Mat3 directions = Mat3::Zero();  ///< columns: unit vectors along them, the first component of each that is not zero positive
};
PrincipalAxes principal_axes(const Measures& measures);

}  // namespace tanktread::surface
