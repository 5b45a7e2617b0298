#pragma once
// Smallest distance between two surfaces, and widths of the films between surfaces.

#include <array>
#include <span>
#include <vector>

#include <Eigen/Geometry>

#include "base/types.hpp"
#include "spline/space.hpp"
#include "surface/patch.hpp"

namespace tanktread::surface {

/// The closest points of two surfaces and their distance, which is 0 if the surfaces touch or intersect.
struct ClosestPoints {
  Vec3 first, second;
  double gap = 0;
  std::array<spline::Site, 2> sites{};  ///< element and local coordinates of the closest points on the two surfaces, if points were found
};

/// Binary tree of bounding boxes around the Bezier points of a surface's elements. If the surface moves, a new tree must be built.
class ElementBoxes {
 public:
  struct Box {
    Eigen::AlignedBox3d bounds;
    int first, last;    ///< the box contains element(first) .. element(last - 1)
    int child[2] = {};  ///< indices in boxes() of the two halves of a box with several elements
  };

  /// `surface` must outlive the tree. `elements`: elements that the tree contains; all elements if not given.
  explicit ElementBoxes(const Patches& surface, std::vector<int> elements = {});

  const Patches& surface() const { return surface_; }
  const std::vector<Box>& boxes() const { return boxes_; }  ///< all boxes of the tree; the first one is the root
  const Eigen::AlignedBox3d& whole() const { return boxes_[0].bounds; }
  int element(int k) const { return order_[static_cast<std::size_t>(k)]; }

 private:
  int split(int first, int last);

  const Patches& surface_;
  std::vector<int> order_;
  std::vector<Eigen::AlignedBox3d> own_;  // bounding box of each element
  std::vector<Box> boxes_;
};

/// Returns the closest points of two surfaces if their distance is below `beyond`; otherwise returns `beyond` as the distance. Uses branch and bound:
/// divides the pair of boxes, elements or parts of elements with the smallest lower bound of the distance, until no pair can be closer than the best
/// points found by more than `tolerance`. The bounds of parts come from separating planes between their Bezier points. If the surfaces are nearly
/// parallel, the error of these bounds is much smaller than the size of the parts.
ClosestPoints closest_points(const ElementBoxes& first, const ElementBoxes& second, double tolerance, double beyond);

/// Returns the smallest distance between a surface with the control net `net` and a wall, below `beyond` as closest_points() does. If the wall has a
/// period > 0 along x1, also of the images of the surface in the next periods, because the surface may extend beyond the end of the period.
/// `elements`: see ElementBoxes. `period`, `tolerance` and `beyond` are lengths.
double gap_to_wall(const BezierMap& map, const Net& net, const std::vector<int>& elements, const ElementBoxes& wall, double period, double tolerance,
                   double beyond);

/// Refines the closest points `near` of two elements by Newton's method. `first` and `second` are the patches of the elements. At the result, the
/// line that connects the points is normal to both surfaces. The points may lie up to a tenth of an element beyond its edges. If the method fails,
/// returns the points at the local coordinates given by `near`.
ClosestPoints nearest_points(const Patch& first, const Patch& second, const ClosestPoints& near);

/// Returns, for each element of a surface, the width of the film between the element and the other surfaces. The width is the smallest distance from
/// 3 x 3 points of the element to the tangent planes of the other elements, where the tangent plane of an element is taken at the nearest of 5 x 5
/// sample points. The error of the width is h^2 k/8, with k the curvature of the other surface and h a quarter of the element length of that surface.
/// The width is infinite if no other surface is within `reach`.
std::vector<double> film_widths(const Patches& surface, std::span<const Patches* const> others, double reach);

}  // namespace tanktread::surface
