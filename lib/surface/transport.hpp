#pragma once
// Tank-treading of a surface with a velocity, and the rate of change of its shape.

#include <span>
#include <vector>

#include "surface/geometry.hpp"

namespace tanktread::surface {

/// Tank-treading of a surface, as means over the section curve: the intersection of the surface with the plane x2 = centre_2 through the centroid.
/// Velocity and frequency are positive if the side of larger x3 moves in the direction of x1: clockwise with x1 to the right and x3 up.
struct TankTreading {
  double velocity = 0;   ///< mean tangential velocity V_T (6.5), along e2 x n
  double frequency = 0;  ///< mean angular velocity omega (6.6) of the material points on this curve, radians/time
};

/// Returns the mean tank-treading velocity and frequency over the section curve, the intersection with the plane x2 = centre_2. Both are zero if the
/// plane does not intersect the surface. The centroid of the surface is `centre` and moves with velocity `of_centre`. For an elastic membrane, the
/// mean frequency is weighted by length on the net `unstressed`. If `unstressed` is null, the weight of a part of the section curve is the time that
/// a material point needs to pass it, and the frequency is zero if some point is at rest. The section curve is computed on a grid of flat triangles
/// with six intervals per element and direction; the relative error is about 1e-4 on coarse meshes.
TankTreading tank_treading(const BezierMap& map, const Net& x, const Net& v, const Net* unstressed, const Vec3& centre, const Vec3& of_centre);

/// Returns the sums over the given elements of the integrals that shape_velocity() needs, for a surface with control net x that moves with velocity
/// v. The results for disjoint sets of elements add up to the result for the whole surface. The integrals use three Gauss points per direction.
/// `radius`: R_C, the radius of the sphere of equal volume.
std::vector<double> shape_velocity_sums(const BezierMap& map, const Net& x, const Net& v, double radius, std::span<const int> elements);

/// Returns the rate of change of the shape: the root mean square of the normal velocity v.n, projected onto solid harmonics of degree three at
/// most, in the frame of the centroid (6.8). If `along_x1` is true, the frame moves only along x1. The result is zero for a steady shape, even if
/// the mesh moves along the surface. Discretisation errors that move with a tank-treading mesh are of higher degree, so they do not contribute.
/// Unit: length/time.
double shape_velocity(std::span<const double> sums, bool along_x1);

}  // namespace tanktread::surface
