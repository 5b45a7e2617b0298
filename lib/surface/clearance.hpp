#pragma once
// Smallest distance of a surface to the wall of a tube.

#include "base/types.hpp"
#include "surface/walls/outline.hpp"
#include "surface/patch.hpp"

namespace tanktread::surface {

/// A point of a surface and its distance to the outline of a straight tube along x1. The distance is negative outside the tube.
struct Clearance {
  Vec3 x = Vec3::Zero();
  double gap = 0;
  int pieces = 0;  ///< number of pieces (parts of elements) examined, a measure of the work
};

/// Returns the point of the surface nearest to the outline, or farthest outside it. No other point is nearer by more than 1e-8 R, or farther outside
/// by more than 1e-3 R, with R the radius of the outline. The search divides the surface into pieces. For each piece, a disc that osculates the
/// outline gives a lower bound of the distance.
Clearance clearance(const Patches& surface, const Outline& outline);

}  // namespace tanktread::surface
