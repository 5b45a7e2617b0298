#pragma once
// Several surfaces as one: their spaces side by side.

#include <span>
#include <vector>

#include "base/types.hpp"
#include "spline/space.hpp"

namespace tanktread::spline {

/// Where one of several spaces lies in the space of all: control points (and collocation points) first_point .. first_point + n_points - 1, elements
/// first_element .. first_element + n_elements - 1.
struct Block {
  int first_point = 0, n_points = 0;
  int first_element = 0, n_elements = 0;

  /// Its rows of a net of all.
  auto rows(Net& net) const { return net.middleRows(first_point, n_points); }
  auto rows(const Net& net) const { return net.middleRows(first_point, n_points); }
  bool holds(int point) const { return point >= first_point && point < first_point + n_points; }
};

/// The blocks of spaces that lie one after the other in their order.
std::vector<Block> blocks(std::span<const Space* const> spaces);

/// The space of all of them: Gamma = Gamma_1 + Gamma_2 + …, each as it was.
Space stacked(std::span<const Space* const> spaces);

/// The block that is the whole of one space.
Block whole(const Space& space);

}  // namespace tanktread::spline
