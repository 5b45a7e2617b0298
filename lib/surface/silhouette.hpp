#pragma once
// Outline of a surface in parallel projection, as a camera sees it.

#include "base/types.hpp"
#include "surface/bezier_points.hpp"

namespace tanktread::surface {

/// Area and circularity 4 pi A/P^2 (A: area, P: perimeter; 1 for a circle) of the outline of a surface, and of the convex hull of the outline.
struct Silhouette {
  double area = 0, circularity = 0, hull_area = 0, hull_circularity = 0;
};

/// Computes the silhouette of the connected closed surface x in the direction `view`, which need not be a unit vector. The outline is the outer
/// boundary of the projection. Background that the projection encloses counts as its area. The relative error is of the order of 1e-6. Throws
/// RunFailure if the surface contains NaN.
Silhouette silhouette(const BezierMap& map, const Net& x, const Vec3& view);

}  // namespace tanktread::surface
