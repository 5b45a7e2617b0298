#pragma once
// What the rows of the series are made of.

#include <algorithm>
#include <array>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "app/body.hpp"
#include "app/series.hpp"

namespace tanktread {

/// What every rank has, in their order. Collective.
template <std::size_t n>
std::vector<std::array<double, n>> gathered(const coupling::Ranks& ranks, const std::array<double, n>& mine) {
  std::vector<double> all(n * static_cast<std::size_t>(ranks.size()), 0.);
  std::ranges::copy(mine, all.begin() + static_cast<std::ptrdiff_t>(n) * ranks.rank());
  ranks.add(all);
  std::vector<std::array<double, n>> values(all.size() / n);
  for (std::size_t k = 0; k < all.size(); ++k) values[k / n][k % n] = all[k];
  return values;
}

/// What every capsule and drop has that its own shape x and slope tell. Collective.
Moment moment(const Scene& scene, const Body& body, const surface::Geometry& geometry, const membrane::Membrane& membrane, const Net& x,
              const Net& slope, const coupling::Ranks& ranks);

/// Velocity of the centroid, and tank-treading, of a surface x whose material moves by v.
void add_treading(const Scene& scene, const Body& body, const surface::Geometry& geometry, const Net& x, const Net& v, Moment& now);

/// Computes D and inclination in the plane of the flow, and extents. If the flow is not planar, the plane is that of the longest and the shortest
/// semi-axis; if one of these is not distinct from the middle one, the inclination is NaN. Ranks share the elements. Collective.
surface::Deformation deformation(const surface::Geometry& geometry, const FlowPlane& plane, const Net& x, surface::Measures measures,
                                 const coupling::Ranks& ranks);

/// S:E/(2 mu V E:E) of the moment's stresslet S, E the symmetric part of the flow's gradient; 0 of a flow that is not affine.
double intrinsic_viscosity(const Body& body, double viscosity, const Moment& now);

/// What every rigid body has at x, where it moves and turns by `quaternion`, whose centre is the moment's; its stresslet. Collective.
Moment rigid_moment(const Scene& scene, const Body& body, const surface::Geometry& geometry, const Net& x, const coupling::RigidMotion& motion,
                    const Eigen::Quaterniond& turn, const Mat3& stresslet, const coupling::Ranks& ranks);

/// Angle of y in the plane, in degrees from its first direction in the sense of tank-treading, in (-180, 180].
double angle_in(const FlowPlane& plane, const Vec3& y);

/// The site of the surface that is seen from `from` in the first direction of the plane.
spline::Site site_ahead(const spline::Space& space, const Net& x, const Vec3& from, const FlowPlane& plane);

/// Largest |v.n| over these collocation sites, over rate x R_C: zero when the shape is steady. In a tube of the velocity relative to the centroid's
/// along the tube, over the mean velocity.
double normal_velocity(const Scene& scene, const Body& body, const surface::Geometry& geometry, const Net& x, const Net& slope,
                       std::span<const int> sites);

}  // namespace tanktread
