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
/// with p + 2 Gauss points a direction and element. The matrix M depends on the space alone. Its systems are solved to round-off by conjugate
/// gradients with a factorised sparse approximate inverse, M^-1 ~ G^T G (Kolotilina & Yeremin, SIAM J. Matrix Anal. Appl. 14, 1993), G with the
/// strongest couplings of M only: 50 iterations on a fine mesh, where the diagonal alone takes 200. A factorisation of M takes 25 times as long at
/// 55,298 control points.
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
  /// A lower triangle, row after row, the diagonal last in each.
  struct Rows {
    std::vector<int> start{0}, column;
    std::vector<double> value;
    void close(int diagonal, double entry);  ///< ends a row
  };
  static Rows mass(const spline::Space& space, const Blocks& blocks, const std::vector<Eigen::MatrixXd>& gram);
  static Rows approximate_inverse(const Rows& mass);
  Net solve(const Net& right, const Net& start) const;

  BezierMap map_;
  std::vector<Table> tables_;  ///< a block
  std::vector<double> area_;
  Rows mass_, inverse_;  ///< M and G
};

}  // namespace tanktread::surface
