#pragma once
// How a surface with a velocity moves as a whole, and how it treads.

#include "base/types.hpp"
#include "surface/bezier_points.hpp"

namespace tanktread::surface {

/// Velocity U of the centroid (P-42) of the interior of x when the net moves by v (6.4): exact.
Vec3 centroid_velocity(const BezierMap& map, const Net& x, const Net& v);

/// How a surface treads along the curve in which the plane x2 = centre_2 cuts it; positive where the side of larger x3 moves along x1, clockwise
/// with x1 to the right and x3 up.
struct Treading {
  double velocity = 0;   ///< mean tangential velocity V_T (6.5), along e2 x n
  double frequency = 0;  ///< mean angular velocity omega (6.6) of the material points of the curve, radians over time
};

/// Of a surface whose centroid `centre` moves by `of_centre`. Points of an elastic membrane are weighed by their length on the `unstressed` net;
/// without one, by the time that a point takes, and omega is zero where some point of the curve rests. The curve is cut on a grid of triangles,
/// six intervals an element: 1e-4 on coarse meshes. Zeros where the plane misses the surface.
Treading tank_treading(const BezierMap& map, const Net& x, const Net& v, const Net* unstressed, const Vec3& centre, const Vec3& of_centre);

}  // namespace tanktread::surface
