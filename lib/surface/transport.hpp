#pragma once
// How a surface with a velocity treads, and how fast its shape changes.

#include <span>
#include <vector>

#include "surface/geometry.hpp"

namespace tanktread::surface {

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

/// Of these elements: integrals over the surface of net x that moves by v, of which sums over all elements make `shape_velocity`. Gauss points,
/// three a direction. `radius`: R_C.
std::vector<double> shape_velocity_sums(const BezierMap& map, const Net& x, const Net& v, double radius, std::span<const int> elements);

/// How fast the shape changes: root mean square of the part of the normal velocity v.n that solid harmonics of degree three at most can follow, in
/// the frame of the centroid (6.8): with it along x1 only where `along_x1`. Zero for a steady shape, and for a motion of the mesh along it; what the
/// mesh imprints on a shape that treads through it is of higher degree. Length/time.
double shape_velocity(std::span<const double> sums, bool along_x1);

}  // namespace tanktread::surface
