#pragma once
// Tank-treading of a surface with a velocity, and the rate of change of its shape.

#include <span>
#include <vector>

#include "surface/geometry.hpp"

namespace tanktread::surface {

/// Tank-treading along the curve in which the plane x2 = centre_2 cuts the surface. It is positive if the side of larger x3 moves along x1: clockwise
/// with x1 to the right and x3 up.
struct Treading {
  double velocity = 0;   ///< mean tangential velocity V_T (6.5), along e2 x n
  double frequency = 0;  ///< mean angular velocity omega (6.6) of the material points of the curve, radians/time
};

/// Returns the tank-treading of a surface whose centroid `centre` moves with velocity `of_centre`. Points of an elastic membrane are weighted by
/// their length on the `unstressed` net. Without one, they are weighted by the time that a point needs, and omega is zero if some point of the curve
/// is at rest. The curve is computed on a grid of triangles with six intervals per element: error 1e-4 on coarse meshes. If the plane misses the
/// surface, both values are zero.
Treading tank_treading(const BezierMap& map, const Net& x, const Net& v, const Net* unstressed, const Vec3& centre, const Vec3& of_centre);

/// Returns integrals over the given elements of the net x that moves by v. shape_velocity() uses their sums over all elements. Three Gauss points per
/// direction. `radius`: R_C.
std::vector<double> shape_velocity_sums(const BezierMap& map, const Net& x, const Net& v, double radius, std::span<const int> elements);

/// Returns the rate of change of the shape: the root mean square of the normal velocity v.n, projected onto solid harmonics of degree three at most,
/// in the frame of the centroid (6.8). If `along_x1` is true, the frame moves only along x1. The result is zero for a steady shape and for a motion
/// of the mesh along it. Mesh imprints on a tank-treading shape are of higher degree, so they do not count. Length/time.
double shape_velocity(std::span<const double> sums, bool along_x1);

}  // namespace tanktread::surface
