#pragma once
// Least-squares fits of control nets to given points.

#include <functional>
#include <vector>

#include "base/types.hpp"
#include "surface/bezier_points.hpp"

namespace tanktread::surface {

/// Control nets that fit a given field best in the mean square over the parametric surface,
///
///   sum_e area_e int_e |sum_A N_A P_A - f|^2 ds dt = min,
///
/// with p + 2 Gauss points a direction and element. The matrix depends on the space alone. Its systems are solved to round-off by conjugate
/// gradients, preconditioned by the diagonal: mass matrices of splines scaled so are well conditioned on any mesh (200 iterations on a fine one).
/// Nothing is factored, which would take ten times as long at 55,298 control points.
class LeastSquaresFit {
 public:
  explicit LeastSquaresFit(const spline::Space& space);

  /// f(x) of the points of a given surface: one step of fitting a surface to its own image. The functions of the space must be linearly independent.
  Net fit_image(const Net& net, const std::function<Vec3(const Vec3& x)>& f) const;

 private:
  /// What all elements of a degree share.
  struct Table {
    Eigen::MatrixXd value;     ///< Bernstein values at the Gauss points, shape (n_q, n_b)
    Eigen::MatrixXd weighted;  ///< value^T times the Gauss weights, shape (n_b, n_q)
  };
  /// Entries of the matrix, row after row.
  struct Mass {
    std::vector<int> start{0}, column;
    std::vector<double> value, diagonal;
  };
  static Mass mass(const spline::Space& space, const Blocks& blocks, const std::vector<Eigen::MatrixXd>& gram);
  Net solve(const Net& right, const Net& start) const;

  BezierMap map_;
  std::vector<Table> tables_;  ///< a block
  std::vector<double> area_;
  Mass mass_;
};

}  // namespace tanktread::surface
