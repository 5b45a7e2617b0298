#pragma once
// Smallest and largest value of a quantity on a closed surface. The quantity is a coordinate, or the distance of the points of a plane section from a
// given point. coordinate_range(), lowest() and section_distances() find the extrema of the spline surface itself by Newton's method.

#include <algorithm>
#include <limits>

#include "base/types.hpp"
#include "surface/patch.hpp"

namespace tanktread::surface {

struct Range {
  double smallest = std::numeric_limits<double>::infinity(), largest = -std::numeric_limits<double>::infinity();  ///< empty range
};

/// Returns the smallest range that contains both given ranges.
inline Range wider(const Range& a, const Range& b) { return {std::min(a.smallest, b.smallest), std::max(a.largest, b.largest)}; }

/// Returns the smallest and largest coordinate x_{c+1} of the Bezier points, which bound the patch.
Range hull(const Patch& patch, int c);

/// Returns the smallest and largest coordinate x_{c+1} on the surface, to round-off. The range of a whole surface is the union over its parts.
Range coordinate_range(const Patches& surface, int c);

/// Returns the point of the surface with the smallest coordinate x_{c+1}, to round-off.
Vec3 lowest(const Patches& surface, int c);

/// Returns the shortest and longest distance of `centre` to the curve in which the plane x2 = centre_2 cuts the surface, to round-off if the
/// extremum is simple (nonzero second derivative). No symmetry of the surface is assumed. The range of a whole surface is the union over its parts.
/// The range is empty if the plane misses the surface.
Range section_distances(const Patches& surface, const Vec3& centre);

}  // namespace tanktread::surface
