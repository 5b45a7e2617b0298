#pragma once
// Membranes that nearly keep their area: the stiff part of their tangent.

#include <vector>

#include <Eigen/SparseCholesky>

#include "membrane/membrane.hpp"

namespace tanktread::membrane {

/// What resists a change of area at points of its own (3.13), as conditions, one a point: the gradient of their energy is D't, the stiff part of its
/// second derivative D'D. Where control point A gives way to a force by m_A of velocity over force,
///
///   P = (1 + time m D'D)^-1 = 1 - time m D'(1 + time D m D')^-1 D                                                                 (4.25)
///
/// takes out of a displacement what changes these areas, the more of it the stiffer the membrane is: nearly the inverse of the system of an implicit
/// step where that is stiff. And the t of a shape are brought to those of another one by the like of it.
class AreaConstraint {
 public:
  /// `mobility`: m, a number a control point.
  AreaConstraint(const Membrane& membrane, const Eigen::VectorXd& mobility);

  /// Whether the membrane has no such points.
  bool empty() const { return points_.empty(); }

  /// Takes D and t at x.
  void place(const Net& x) { now_ = rows(x), time_ = 0; }

  /// Takes the time of P.
  void factor(double time);

  /// P r.
  Net apply(const Net& r) const { return r - taken(now_.d * Eigen::Map<const Eigen::VectorXd>(r.data(), r.size())); }

  /// Moves x to where t are those at `like`, to the second order of what is missing, the time of P being `time`. Leaves x as its place.
  void bring(Net& x, const Net& like, double time);

 private:
  struct Point {
    int element;
    spline::Basis basis;
    AreaElasticity law;
    double inverse_det, area;  // of the unstressed surface: 1/|G| and the weight
  };
  struct Rows {
    Eigen::SparseMatrix<double, Eigen::RowMajor> d;
    Eigen::VectorXd t;
  };
  Rows rows(const Net& x) const;
  Net taken(const Eigen::VectorXd& at_points) const;

  const spline::Space* space_;
  std::vector<Point> points_;
  Eigen::VectorXd mobility_;  // three times each
  Rows now_;
  double time_ = 0;  // 0: not factored
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> system_;
};

}  // namespace tanktread::membrane
