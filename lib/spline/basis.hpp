#pragma once
// Values and derivatives of the spline functions of an element at one point, and Bezier points of a field.

#include "base/types.hpp"
#include "spline/bernstein.hpp"
#include "spline/space.hpp"

namespace tanktread::spline {

/// Values and derivatives of the functions of an element. Entry i belongs to control point element.points[i]. Derivatives are with respect to the
/// local coordinates s, t in [0, 1].
struct Basis {
  Eigen::VectorXd value, s, t;  ///< values N and derivatives dN/ds and dN/dt; the derivatives are empty if `derivatives` is 0
  Eigen::VectorXd ss, st, tt;   ///< second derivatives; empty unless `derivatives` is 2
};

/// Evaluates the functions of an element and their derivatives up to the order `derivatives` = 0, 1 or 2. Arrays of higher derivatives are empty.
Basis basis(const Element& element, double s, double t, int derivatives = 1);

/// Bezier points of a field on an element of degree p. Row (p + 1) j + i is Bezier point i along s and j along t. Uses no heap memory.
using BezierPoints = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::ColMajor, (most_polynomial_degree + 1) * (most_polynomial_degree + 1), 3>;
BezierPoints bezier_points(const Element& e, const Net& field);

}  // namespace tanktread::spline
