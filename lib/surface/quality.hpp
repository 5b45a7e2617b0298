#pragma once
// Mesh quality: folded and stretched elements.

#include <span>

#include "base/types.hpp"
#include "surface/bezier_points.hpp"

namespace tanktread::surface {

/// The worst elements of a surface, computed at 4 x 4 Gauss points of each Bezier element.
struct Quality {
  /// Smallest value, over all points, of (a1 x a2).m divided by the mean of |a1 x a2| over the points of the element. a1 and a2 are the tangents, and
  /// m is the unit vector along the sum of a1 x a2 on the element. The value is near 1 on an undistorted element and zero or less on a folded one.
  /// The next two members are the element and the position with the smallest value.
  double jacobian_ratio = 1;
  int folded_element = 0;
  Vec3 folded_place = Vec3::Zero();

  /// Largest aspect ratio of an element: the ratio of the mean lengths of the tangents a1 and a2, or the inverse ratio if it is larger. For a
  /// straight element this is L_alpha/L_beta of (1.4).
  double aspect_ratio = 1;
  int stretched_element = 0;

  /// Largest angle between the normal at a point and the vector m of its element, in radians: half the angle through which the surface turns within
  /// an element. On a sphere with n elements per side it is about 0.95/n.
  double tilt = 0;
};

/// Computes the quality of the given elements of a surface. Throws RunFailure, naming the control point, if a control point is
/// not finite.
Quality quality(const BezierMap& map, const Net& net, std::span<const int> elements);

/// Returns the worse value of each measure in a and b, with the elements of the two ratios.
Quality worse(const Quality& a, const Quality& b);

/// Throws RunFailure, naming element and position, if an element is folded: if its jacobian_ratio is not above `least`.
void require_sound(const Quality& quality, double least = 0);

}  // namespace tanktread::surface
