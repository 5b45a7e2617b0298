#pragma once
// The plane that deformation and tank-treading are measured in.

#include <string>

#include "base/types.hpp"
#include "stokes/flow/flow_options.hpp"

namespace tanktread {

/// A plane through the centroid. Rows of `axes`: its first direction a, its normal b x a, its second direction b: the plane x1 x3 has those of space.
struct FlowPlane {
  Mat3 axes = Mat3::Identity();
  bool holds_flow = true;  ///< a flow that is not planar is in no plane: D is then taken in that of the longest and the shortest axis of inertia

  bool fixed() const { return axes.isIdentity(0); }                     ///< x1 x3
  Vec3 components(const Vec3& x) const { return axes * x; }             ///< components along a, b x a, b
  Net turned(const Net& x) const { return fixed() ? x : Net(x * axes.transpose()); }
  std::string description() const;
};

/// The plane with this normal: a is the first axis of space that is not along the normal, projected; the largest component of b is positive.
FlowPlane plane_normal_to(Vec3 normal);

/// x1 x3 of every flow but `linear`; of that, the plane in which it moves and changes. Where there is none, the plane normal to its vorticity, in
/// which points of the surface go round.
FlowPlane flow_plane(const stokes::FlowOptions& flow);

}  // namespace tanktread
