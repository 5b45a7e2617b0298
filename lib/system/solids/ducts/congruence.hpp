#pragma once
// Rotations and reflections of the cross-section that map the wall of a tube to itself.

#include <vector>

#include "base/types.hpp"
#include "surface/walls/tube_wall.hpp"

namespace tanktread::coupling {

/// Orthogonal matrix Q with Q e1 = e1 (e1: axis of the tube) that maps the wall to itself: rotation about x1, reflection of the cross-section, or
/// both.
struct WallSymmetry {
  Mat3 q;
  std::vector<int> image, source;  ///< Q maps control point k of each cross-section (ring) to image[k]. source: inverse of image
};

/// Returns the maps of the wall onto itself, the identity first: 2 n maps for a circle with n points around, 4 for a rectangle, 2 for the
/// cross-section of a bent channel. A map is accepted if it moves every control point to a control point and every collocation point (`sites`) to a
/// collocation point, up to 1e-10 tube radii.
///
/// The kernels do not change if source, target and force are rotated or reflected together. The 3 x 3 blocks of an operator A on the wall, for target
/// i and source p, therefore satisfy A(Q i, Q p) = Q A(i, p) Q^T.
std::vector<WallSymmetry> wall_symmetries(const surface::TubeWall& wall, const Net& sites);

/// Orbit representative of a point of a cross-section (ring): the point of the same ring that a map moves to the given point. Matrix rows are
/// assembled only for representatives.
struct OrbitRepresentative {
  int point;               ///< index of the representative in the ring: the smallest index of a point that a map moves to the given point
  const WallSymmetry* from;  ///< map that moves the representative to the given point; points into the list passed to orbit_representatives()
};

/// Returns the orbit representative of each of the n_around points of a ring.
std::vector<OrbitRepresentative> orbit_representatives(const std::vector<WallSymmetry>& maps, int n_around);

}  // namespace tanktread::coupling
