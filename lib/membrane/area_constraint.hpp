#pragma once
// Conditions of constant local area, which represent the stiff part of the tangent stiffness of nearly area-incompressible membranes.

#include <vector>

#include <Eigen/SparseCholesky>

#include "membrane/membrane.hpp"

namespace tanktread::membrane {

/// Elastic resistance to area changes, integrated by a separate quadrature (3.13). It is written as one area condition per Gauss point; t is the
/// vector of these conditions. With D the scaled gradient of t and D' its transpose, the gradient of the elastic area energy is D't, and the stiff
/// part of its second derivative is D'D. With the mobility m_A of control point A (velocity per force) and the step factor `time` of an implicit
/// scheme, the operator
///
///   P = (1 + time m D'D)^-1 = 1 - time m D'(1 + time D m D')^-1 D                                                                 (4.25)
///
/// removes from a displacement the part that changes the areas. The stiffer the membrane is, the more of this part is removed. In the stiff
/// directions, P approximates the inverse of the matrix of an implicit step. P is also used to move a shape until its conditions t have the values of
/// another shape.
class AreaConstraint {
 public:
  /// Sets up one condition of constant local area per Gauss point. `mobility`: m_A, the velocity of control point A per unit of force on it.
  AreaConstraint(const Membrane& membrane, const Eigen::VectorXd& mobility);

  /// Returns true if there are no area conditions. Only materials whose area elasticity (3.13) is integrated separately, with `Membrane/area points`
  /// equal to 1, have area conditions.
  bool empty() const { return points_.empty(); }

  /// Evaluates at the shape x, for the operator P (4.25): the value t of the area condition at every Gauss point and the scaled gradient D of t,
  /// which are stored in `now_`. The matrix of factor() is then out of date.
  void set_shape(const Net& x) { now_ = rows(x), time_ = 0; }

  /// Factors the matrix 1 + time D m D' of the operator P (4.25). D: gradient of the area conditions at the shape set by set_shape(). m: mobility.
  /// `time`: step factor of the implicit scheme.
  void factor(double time);

  /// Returns P r, with the operator P of (4.25).
  Net apply(const Net& r) const { return r - removed(now_.d * flat(r)); }

  /// Moves the shape x so that the area at every Gauss point nearly equals the area in the shape `like`. Takes two steps with the operator P (4.25),
  /// for which `time` is the argument of factor(). The remaining area error is of second order in the initial error. Afterwards, t and D are
  /// evaluated at the new x, as by set_shape(x).
  void restore_areas(Net& x, const Net& like, double time);

 private:
  struct Point {
    int element;
    spline::Basis basis;
    AreaElasticity law;
    double inverse_det, area;  // inverse_det: inverse determinant 1/|G| of the unstressed metric. area: Gauss weight times sqrt|G|
  };
  struct Rows {
    Eigen::SparseMatrix<double, Eigen::RowMajor> d;
    Eigen::VectorXd t;
  };
  Rows rows(const Net& x) const;
  Net removed(const Eigen::VectorXd& at_points) const;

  const spline::Space* space_;
  std::vector<Point> points_;
  Eigen::VectorXd mobility_;  // mobility of each control point, three times in succession (once per component)
  Rows now_;
  double time_ = 0;  // argument of the last factor(); 0 if not factored
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> system_;
};

}  // namespace tanktread::membrane
