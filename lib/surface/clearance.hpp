#pragma once
// The smallest distance of a surface to the wall of a tube.

#include "base/types.hpp"
#include "surface/outline.hpp"
#include "surface/patch.hpp"

namespace tanktread::surface {

/// A place of a surface and its distance to the outline of a straight tube along x1; negative outside of the tube.
struct Clearance {
  Vec3 x;
  double gap = 0;
};

/// The place of the surface that is nearest to the outline, or farthest outside of it. Pieces of the surface are quartered, those of the
/// smallest possible distance first, until none can be nearer than the best place found by 1e-9 of the outline's radius; on a sixteenth of an
/// element the distance has one minimum.
Clearance clearance(const Patches& surface, const Outline& outline);

}  // namespace tanktread::surface
