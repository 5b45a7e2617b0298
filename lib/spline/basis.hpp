#pragma once
// What the spline functions of an element are: values and derivatives at one place, and Bezier points.

#include "base/types.hpp"
#include "spline/bernstein.hpp"
#include "spline/space.hpp"

namespace tanktread::spline {

/// Entry i belongs to control point element.points[i]. Derivatives by the element's own coordinates s, t in [0, 1].
struct Basis {
  Eigen::VectorXd value, s, t;  ///< N, N_,s, N_,t
  Eigen::VectorXd ss, st, tt;   ///< filled for derivatives = 2 only
};

/// derivatives = 0, 1 or 2; arrays beyond that stay empty.
Basis basis(const Element& element, double s, double t, int derivatives = 1);

/// Bezier points of a field on an element, row (p + 1) j + i; without allocation.
using BezierPoints = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::ColMajor, (max_degree + 1) * (max_degree + 1), 3>;
BezierPoints bezier_points(const Element& e, const Net& field);

}  // namespace tanktread::spline
