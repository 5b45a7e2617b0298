#pragma once
// How fast the shape of a surface changes, whatever its mesh does along it and at the size of its elements.

#include <span>
#include <vector>

#include "base/types.hpp"
#include "surface/bezier_points.hpp"

namespace tanktread::surface {

/// Of these elements: integrals over the surface of net x that moves by v, of which sums over all elements make `shape_velocity`. Gauss points,
/// three a direction. `radius`: R_C.
std::vector<double> shape_velocity_sums(const BezierMap& map, const Net& x, const Net& v, double radius, std::span<const int> elements);

/// Root mean square of the part of the normal velocity v.n that solid harmonics of degree three at most can follow, in the frame of the centroid
/// (6.8): with it along x1 only where `along_x1`. Zero for a steady shape, and for a motion of the mesh along it; what the mesh imprints on a shape
/// that treads through it is of higher degree. Length/time.
double shape_velocity(std::span<const double> sums, bool along_x1);

}  // namespace tanktread::surface
