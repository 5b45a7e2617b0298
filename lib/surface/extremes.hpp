#pragma once
// Extremal coordinates of a closed surface and extremal distances on a plane section, by Newton's method on the polynomials themselves.

#include "base/types.hpp"
#include "surface/patch.hpp"

namespace tanktread::surface {

struct Range {
  double smallest = 0, largest = 0;
};

/// Smallest and largest coordinate x_{c+1} on the surface, to round-off.
Range coordinate_range(const Patches& surface, int c);

/// Shortest and longest distance of `centre` to the curve in which the plane x2 = centre_2 cuts the surface. To round-off where the surface
/// has a simple extremum; no symmetry is assumed. Throws RunFailure when the plane misses the surface.
Range section_distances(const Patches& surface, const Vec3& centre);

}  // namespace tanktread::surface
