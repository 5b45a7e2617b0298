#pragma once
// Points off a surface at which its layers are evaluated.

#include <optional>
#include <vector>

#include "base/types.hpp"
#include "stokes/layer.hpp"

namespace tanktread::coupling {

/// Points off a surface at which its layers are evaluated, with the near-field data of the current shape.
struct PointsOff {
  Net at;                ///< positions
  std::vector<int> own;  ///< rows of `at` that this rank evaluates
  int first_image_row = stokes::Layer::no_row;  ///< to this row and later ones, only the images of the surface on the lattice contribute
  std::vector<int> nearest{};  ///< the collocation point of the particles that is nearest to each point before `first_image_row`, if they have a
                               ///< double layer; otherwise empty
  std::optional<stokes::Layer::Near> near{};  ///< corrections by near-singular quadrature; if not set, they are computed for each density
};

}  // namespace tanktread::coupling
