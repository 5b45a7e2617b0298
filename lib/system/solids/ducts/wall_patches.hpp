#pragma once
// Preconditioner of the operator of a wall that is solved for by iteration.

#include <vector>

#include "base/types.hpp"
#include "stokes/layer.hpp"
#include "surface/walls/tube_wall.hpp"

namespace tanktread::coupling {

/// Preconditioner for the wall's operator. For each control point, the block of the operator for the 5 x 5 points around it is inverted. Of the
/// inverse, the three rows of the central point are stored.
class WallPatches {
 public:
  /// `points`: control points to compute. `layer`: layer of the wall at its collocation points, with the shape set.
  WallPatches(const surface::TubeWall& wall, stokes::Layer& layer, const std::vector<int>& points);

  /// Applies the preconditioner: computes the rows of f at the control points given to the constructor from the right-hand side `rhs`.
  void apply(const Net& rhs, Net& f) const;

 private:
  struct Patch {
    int point;
    std::vector<int> neighbours;
    Eigen::Matrix<double, 3, Eigen::Dynamic> row;
  };
  std::vector<Patch> patches_;
};

}  // namespace tanktread::coupling
