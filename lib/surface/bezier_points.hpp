#pragma once
// From control nets to the Bezier points of the elements, in the layout that the hot loops work on.

#include <utility>
#include <vector>

#include "base/types.hpp"
#include "spline/space.hpp"

namespace tanktread::surface {

/// All elements of one degree. `place` of an element is its position in `elements`.
struct Block {
  int degree = 3;
  std::vector<int> elements;
};

/// The elements grouped by degree.
struct Blocks {
  std::vector<Block> blocks;
  std::vector<std::pair<int, int>> place;  ///< element -> (block, position in it)
};
Blocks blocks_by_degree(const spline::Space& space);

/// Bezier points of every element of a block. Column c * n_e + k holds component c of element k: shape ((p+1)^2, 3 n_e), column-major,
/// so that (Bernstein table) * (this) gives one contiguous array a component over all nodes of all elements.
Eigen::MatrixXd bezier_points(const spline::Space& space, const Block& block, const Net& net);

}  // namespace tanktread::surface
