#pragma once
// Values and derivatives of the spline functions of an element at one place.

#include "spline/space.hpp"

namespace tanktread::spline {

/// Entry i belongs to control point element.points[i]. Derivatives by the element's own coordinates s, t in [0, 1].
struct Basis {
  Eigen::VectorXd value, s, t;  ///< N, N_,s, N_,t
  Eigen::VectorXd ss, st, tt;   ///< filled for derivatives = 2 only
};

/// derivatives = 0, 1 or 2; arrays beyond that stay empty.
Basis basis(const Element& element, double s, double t, int derivatives = 1);

}  // namespace tanktread::spline
