#pragma once
// Least-squares fits of control nets to given points.

#include <functional>

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "surface/bezier_points.hpp"

namespace tanktread::surface {

/// Control nets that fit a given field best in the mean square over the parametric surface,
///
///   sum_e area_e int_e |sum_A N_A P_A - f|^2 ds dt = min,
///
/// with p + 2 Gauss points a direction and element. The matrix depends on the space alone and is factored once.
class LeastSquaresFit {
 public:
  explicit LeastSquaresFit(const spline::Space& space);

  /// f(element, s, t) at the Gauss points.
  Net fit(const std::function<Vec3(int element, double s, double t)>& f) const;

  /// f(x) of the points of a given surface: one step of fitting a surface to its own image.
  Net fit_image(const Net& net, const std::function<Vec3(const Vec3& x)>& f) const;

 private:
  template <class Field>
  Net solve(Field field) const;

  /// What all elements of a degree share.
  struct Table {
    Eigen::VectorXd s, t;
    Eigen::MatrixXd value;     ///< Bernstein values, shape (n_q, n_b)
    Eigen::MatrixXd weighted;  ///< value^T times the Gauss weights, shape (n_b, n_q)
  };
  BezierMap map_;
  std::vector<Table> tables_;  ///< a block
  std::vector<double> area_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
};

}  // namespace tanktread::surface
