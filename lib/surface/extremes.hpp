#pragma once
// Extremal coordinates of a closed surface and extremal distances on a plane section, by Newton's method on the polynomials themselves.

#include <algorithm>
#include <limits>

#include "base/types.hpp"
#include "surface/patch.hpp"

namespace tanktread::surface {

struct Range {
  double smallest = std::numeric_limits<double>::infinity(), largest = -std::numeric_limits<double>::infinity();  ///< of nothing
};

/// Of two parts.
inline Range wider(const Range& a, const Range& b) { return {std::min(a.smallest, b.smallest), std::max(a.largest, b.largest)}; }

/// Smallest and largest coordinate x_{c+1} on the surface, to round-off. Of a whole surface, the wider of its parts.
Range coordinate_range(const Patches& surface, int c);

/// Shortest and longest distance of `centre` to the curve in which the plane x2 = centre_2 cuts the surface. To round-off where the surface
/// has a simple extremum; no symmetry is assumed. Of a whole surface, the wider of its parts; of nothing when the plane misses it.
Range section_distances(const Patches& surface, const Vec3& centre);

}  // namespace tanktread::surface
