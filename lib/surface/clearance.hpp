#pragma once
// The smallest distance of a surface to the wall of a tube.

#include "base/types.hpp"
#include "surface/outline.hpp"
#include "surface/patch.hpp"

namespace tanktread::surface {

/// A place of a surface and its distance to the outline of a straight tube along x1; negative outside of the tube.
struct Clearance {
  Vec3 x = Vec3::Zero();
  double gap = 0;
  int pieces = 0;  ///< of the surface that were looked at: the work
};

/// The place of the surface that is nearest to the outline, or farthest outside of it. No other place is nearer by 1e-8 of the outline's radius, or
/// farther outside by 1e-3 of it: for each piece of the surface a disc that osculates the outline bounds the distance from below.
Clearance clearance(const Patches& surface, const Outline& outline);

}  // namespace tanktread::surface
