#pragma once
// Least-squares fits of control nets.

#include <functional>
#include <map>
#include <vector>

#include "base/types.hpp"
#include "spline/sparse_systems.hpp"
#include "surface/bezier_points.hpp"

namespace tanktread::surface {

/// Fits control nets to a field f in the mean square over the parametric surface,
///
///   sum_e area_e int_e |sum_A N_A P_A - f|^2 ds dt = min,
///
/// with the parametric area area_e of element e and p + 2 Gauss points per direction on elements of degree p. The matrix depends only on the space.
/// The normal equations are solved iteratively to round-off.
class LeastSquaresFit {
 public:
  explicit LeastSquaresFit(const spline::Space& space);

  /// Returns the control net fitted to f(x), where x are the points of the surface with the control net `net`. Example: f(x) = x/|x| turns a surface
  /// close to the unit sphere into a better approximation of it. The spline functions of the space must be linearly independent.
  Net fit_image(const Net& net, const std::function<Vec3(const Vec3& x)>& f) const;

 private:
  /// Values that depend only on the degree of an element.
  struct Table {
    Eigen::MatrixXd value;     ///< Bernstein values at the Gauss points, shape (n_q, n_b)
    Eigen::MatrixXd weighted;  ///< value^T times the Gauss weights, shape (n_b, n_q)
  };
  BezierMap map_;
  std::map<int, Table> tables_;  ///< tables by degree
  std::vector<double> area_;
  Eigen::SparseMatrix<double, Eigen::RowMajor> matrix_;
  spline::IncompleteSolver solver_;
};

}  // namespace tanktread::surface
