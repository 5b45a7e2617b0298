#pragma once
// Is the mesh still sound: folded and stretched elements.

#include <span>

#include "base/types.hpp"
#include "surface/bezier_points.hpp"

namespace tanktread::surface {

/// The worst elements of a surface, judged at 4 x 4 Gauss points of each Bezier element.
struct Quality {
  /// Smallest (a1 x a2).m / mean of |a1 x a2| over the points of an element, m the direction of the sum of a1 x a2: near 1 on an even element,
  /// zero or less on a folded one. Where it is found, and the place.
  double jacobian_ratio = 1;
  int folded_element = 0;
  Vec3 folded_place = Vec3::Zero();

  /// Largest ratio of the mean lengths of a1 and a2, either way (L_alpha/L_beta of P-37 for a straight element).
  double aspect_ratio = 1;
  int stretched_element = 0;
};

/// Throws RunFailure when a control point is not a finite number, naming it.
Quality quality(const BezierMap& map, const Net& net);
Quality quality(const BezierMap& map, const Net& net, std::span<const int> elements);

/// The worse of each.
Quality worse(const Quality& a, const Quality& b);

/// Throws RunFailure, with element and place, when an element is folded: its jacobian_ratio is `least` or below.
void require_sound(const Quality& quality, double least = 0);

}  // namespace tanktread::surface
