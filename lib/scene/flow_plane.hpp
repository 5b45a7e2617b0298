#pragma once
// Plane of an ambient flow, in which deformation and tank-treading are measured.

#include <optional>
#include <string>

#include "base/types.hpp"
#include "stokes/flow/flow_options.hpp"

namespace tanktread {

/// Plane through the centroid of the particle in which the Taylor parameter D and tank-treading are measured. The rows of `axes` are the first
/// in-plane direction a, the normal (cross product of b and a) and the second in-plane direction b. For the plane x1 x3, `axes` is the identity.
struct FlowPlane {
  Mat3 axes = Mat3::Identity();
  /// rows: direction of a simple shear flow, normal of the plane, direction of the velocity gradient. Set only for a simple shear of the flow type
  /// `linear`; for the type `simple shear`, these directions are the rows of `axes`
  std::optional<Mat3> of_shear;
  /// false if the flow is not planar; the Taylor parameter D is then measured in the plane of the longest and the shortest axis of inertia
  bool contains_flow = true;

  bool fixed() const { return axes.isIdentity(0); }                     ///< returns true if this is the plane x1 x3
  /// Returns the components of the vector x along the three directions that are the rows of `axes`.
  Vec3 components(const Vec3& x) const { return axes * x; }
  Net turned(const Net& x) const { return fixed() ? x : Net(x * axes.transpose()); }
  std::string description() const;
};

/// Returns the plane with this normal. The direction a is the projection of the x1 axis onto the plane, or of the x2 axis if the normal is along x1.
/// The largest component of the direction b is positive.
FlowPlane plane_normal_to(Vec3 normal);

/// Returns the axes of a simple shear flow with this velocity gradient as rows: the direction of the flow, the normal of the plane of the flow, the
/// direction of the gradient. Returns nothing for other flows.
std::optional<Mat3> axes_of_shear(const Mat3& gradient);

/// Returns the plane x1 x3 for every flow type except `linear`. For `linear`, returns the plane of the flow if the flow is planar, which means that
/// the velocity has no component along the normal of the plane and does not change along the normal. Otherwise returns the plane normal to the
/// vorticity, because points of the surface rotate about the vorticity, or the plane x1 x3 if there is no vorticity.
FlowPlane flow_plane(const stokes::FlowOptions& flow);

}  // namespace tanktread
