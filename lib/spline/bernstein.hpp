#pragma once
// Bernstein polynomials of any degree on [0, 1], in plain arrays without allocation, and a cubic B-spline on one interval.

#include <array>

#include <Eigen/Core>

namespace tanktread::spline {

constexpr int most_polynomial_degree = 15;  ///< largest degree of the polynomials; larger than spline::largest_degree of elements

/// Computes B_i(x) = C(p, i) x^i (1 - x)^(p - i), i = 0 .. p, and stores them in value[0 .. p].
void bernstein(int p, double x, double* value);

/// Computes B_i(x) and the first and second derivatives. `second` may be null.
void bernstein(int p, double x, double* value, double* first, double* second);

/// Values and first derivatives of all products B_i(s) B_j(t) of degree p at points (s, t). Shape (points, (p + 1)^2), column (p + 1) j + i.
struct TensorBernstein {
  Eigen::MatrixXd value, s, t;
};
TensorBernstein tensor_bernstein(int p, const Eigen::VectorXd& s, const Eigen::VectorXd& t);

/// Returns the matrix E of degree elevation from p to q >= p: (coefficients of degree q) = E (coefficients of degree p). Shape (q + 1, p + 1).
Eigen::MatrixXd elevation(int p, int q);

/// Returns the matrix S of de Casteljau restriction to [a, b]: (coefficients on [a, b]) = S (coefficients on [0, 1]). Shape (p + 1, p + 1).
/// Extrapolates if [a, b] is not in [0, 1].
Eigen::MatrixXd restriction(int p, double a, double b);

/// Returns the Bernstein coefficients on [a, b] of the cubic B-spline with knots k0 <= .. <= k4. [a, b] must be in [k0, k4], with no knot strictly
/// inside. Coefficient i is the blossom (polar form) f(a, .., a, b, .., b) of the spline with i arguments equal to b.
std::array<double, 4> b_spline_on(const std::array<double, 5>& k, double a, double b);

}  // namespace tanktread::spline
