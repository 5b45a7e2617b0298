#pragma once
// What a rigid body does to itself, between the collocation sites too.

#include <array>

#include <Eigen/Core>

#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"

namespace tanktread::coupling {

/// Projected less collocated, M^-1 int N_A u dG - R^-1 u, of the velocity u that a body's own layers give it, for a viscosity of 1. A spline surface
/// of n elements a side is higher at its collocation sites than between them by some 1/n^4, and on either side of it a velocity is not the same:
/// collocated, a sphere that is turned by a load turns too slowly by 0.035/n^4, and its stresslet in a strain errs as much.
struct OwnLacking {
  std::array<Net, 6> loads;  ///< u = A f of the loads f = e_k and e_k x r, k = 0, 1, 2, r from the centre of the volume
  Eigen::MatrixXd density;   ///< u = H w of any density w, shape (3 N, 3 N); empty for more than `most_points` control points

  /// 72 bytes for each pair of them. In single precision GMRES takes the rounding for a residual that does not fall.
  static constexpr int most_points = 2000;

  OwnLacking(const spline::Space& space, const Net& surface, const quadrature::Options& quadrature);
};

}  // namespace tanktread::coupling
