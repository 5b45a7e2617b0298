#pragma once
// What a wall's traction has to be near each place, by that place's neighbours alone: the preconditioner of a wall too large to be factored.

#include <vector>

#include "base/types.hpp"
#include "stokes/layer.hpp"
#include "surface/tube_wall.hpp"

namespace tanktread::coupling {

/// Rows of the inverses of the wall's operator between few neighbours, five by five: what f_i is where rhs is theirs alone.
class WallPatches {
 public:
  /// Of these control points; `layer`: of the wall at its collocation points, placed.
  WallPatches(const surface::TubeWall& wall, stokes::Layer& layer, const std::vector<int>& points);

  /// Rows of f for these points.
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
