#pragma once
// Mesh quality: folded and stretched elements.

#include <span>

#include "base/types.hpp"
#include "surface/bezier_points.hpp"

namespace tanktread::surface {

/// The worst elements of a surface, from 4 x 4 Gauss points of each Bezier element.
struct Quality {
  /// Smallest ratio of (a1 x a2).m to the mean of |a1 x a2| over the points of an element, with a1, a2 the tangents and m the direction of the sum of
  /// a1 x a2: near 1 on an undistorted element, zero or less on a folded one. The next two members are the element and the position of the smallest
  /// ratio.
  double jacobian_ratio = 1;
  int folded_element = 0;
  Vec3 folded_place = Vec3::Zero();

  /// Largest aspect ratio of an element: the ratio of the mean lengths of the tangents a1 and a2, or the inverse ratio if it is larger. For a
  /// straight element this is L_alpha/L_beta of (P-37).
  double aspect_ratio = 1;
  int stretched_element = 0;
};

/// Computes the quality of all elements of a surface, or of the given elements. Throws RunFailure, naming the control point, if a control point is
/// not finite.
Quality quality(const BezierMap& map, const Net& net);
Quality quality(const BezierMap& map, const Net& net, std::span<const int> elements);

/// Returns, for each measure, the worse one of its values in a and b.
Quality worse(const Quality& a, const Quality& b);

/// Throws RunFailure, with element and position, if an element is folded: its jacobian_ratio is not above `least`.
void require_sound(const Quality& quality, double least = 0);

}  // namespace tanktread::surface
