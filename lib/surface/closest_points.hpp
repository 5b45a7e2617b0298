#pragma once
// The smallest distance of two surfaces, and how narrow the films between surfaces are.

#include <array>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "spline/space.hpp"
#include "surface/patch.hpp"

namespace tanktread::surface {

/// Two surfaces' nearest points and their distance; 0 where the surfaces meet.
struct ClosestPoints {
  Vec3 first, second;
  double gap = 0;
  std::array<spline::Site, 2> sites{};  ///< of these points, where there are any
};

/// Elements of a surface in a binary tree of boxes around their Bezier points, which hold the elements. Made anew for a surface that has moved.
class ElementBoxes {
 public:
  struct Box {
    Eigen::Array3d low, high;
    int first, last;    ///< its elements: element(first) .. element(last - 1)
    int child[2] = {};  ///< of one with several elements
  };

  /// `surface` must outlive the tree.
  explicit ElementBoxes(const Patches& surface);

  const Patches& surface() const { return surface_; }
  const std::vector<Box>& boxes() const { return boxes_; }  ///< the first is around all
  int element(int k) const { return order_[static_cast<std::size_t>(k)]; }

 private:
  int split(int first, int last);

  const Patches& surface_;
  std::vector<int> order_;
  std::vector<Box> own_, boxes_;  // of elements; of the tree
};

/// A bound from below of the distance of what two boxes hold.
double distance(const ElementBoxes::Box& a, const ElementBoxes::Box& b);

/// The nearest points of two surfaces, if they are nearer than `beyond`; otherwise a gap of `beyond`. Pairs of boxes, elements and parts of elements
/// are halved, those first that can be nearest, until none can be nearer than the best points found by `tolerance`. Parts are bounded by planes
/// between their Bezier points: by much less than their size where surfaces lie side by side.
ClosestPoints closest_points(const ElementBoxes& first, const ElementBoxes& second, double tolerance, double beyond);

/// The same, moved along their two elements, `first` and `second`, to where the line between them meets both at right angles: by Newton's method,
/// from the sites of `near`, no farther than a tenth of an element beyond its edges. Where that does not end there, the points at these sites.
ClosestPoints nearest_points(const Patch& first, const Patch& second, const ClosestPoints& near);

/// Of each element of a surface the width of the film between it and others: the smallest of its distances, at 3 x 3 places, from the tangent plane
/// of the nearest of 5 x 5 places of each element there. Right to the square of a quarter of the others' elements, times their curvature, over eight.
/// Infinite where no other is within `reach`.
std::vector<double> film_widths(const Patches& surface, std::span<const Patches* const> others, double reach);

}  // namespace tanktread::surface
