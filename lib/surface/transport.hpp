#pragma once
// How a surface with a velocity moves as a whole, and how it treads.

#include "base/types.hpp"
#include "spline/space.hpp"
#include "surface/geometry.hpp"

namespace tanktread::surface {

/// Velocity U of the centroid (P-42) of the interior of x when the net moves by v (6.4): exact.
Vec3 centroid_velocity(const Geometry& geometry, const Net& x, const Net& v);

/// Mean tangential velocity V_T (6.5) along the curve in which the plane x2 = centre_2 cuts the surface, relative to the velocity `of_centre`
/// and along e2 x n: positive where the side of larger x3 moves along x1, clockwise with x1 to the right and x3 up. The curve is cut on a grid
/// of triangles, six intervals an element: 1e-4 on coarse meshes. Zero where the plane misses the surface.
double tank_treading_velocity(const spline::Space& space, const Net& x, const Net& v, const Vec3& centre, const Vec3& of_centre);

}  // namespace tanktread::surface
