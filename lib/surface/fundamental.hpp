#pragma once
// Sums over a symmetric surface, from one of each set of elements that are images of one another.

#include <functional>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "surface/symmetry.hpp"

namespace tanktread::surface {

/// One of each set, the one with most fundamental points, ascending; and 1 over the number of images (the identity is one) that leave it in place.
struct FundamentalElements {
  std::vector<int> element;
  std::vector<double> weight;

  bool whole() const;  ///< none is an image of itself
};

/// `points(e)`: the control points of element e.
FundamentalElements fundamental_elements(const Symmetry& symmetry, int n_elements, const std::function<std::span<const int>(int)>& points);

/// From what fundamental elements, each with its weight, add to all rows of a symmetric field, the rows of the fundamental points of the field.
void fold(const Symmetry& symmetry, Net& sums);

}  // namespace tanktread::surface
