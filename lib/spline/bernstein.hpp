#pragma once
// Bernstein polynomials of any degree on [0, 1], on plain arrays and without allocation; one cubic B-spline on one interval.

#include <array>

#include <Eigen/Core>

namespace tanktread::spline {

constexpr int max_degree = 15;

/// B_i(x) = C(p, i) x^i (1 - x)^(p - i), i = 0 .. p, into value[0 .. p].
void bernstein(int p, double x, double* value);

/// The same with first and second derivatives; `second` may be null.
void bernstein(int p, double x, double* value, double* first, double* second);

/// Degree elevation from p to q >= p: (coefficients of degree q) = E (coefficients of degree p). Shape (q + 1, p + 1).
Eigen::MatrixXd elevation(int p, int q);

/// De Casteljau restriction to [a, b]: (coefficients on [a, b]) = S (coefficients on [0, 1]). Shape (p + 1, p + 1).
/// Extrapolates when [a, b] leaves [0, 1].
Eigen::MatrixXd restriction(int p, double a, double b);

/// Bernstein coefficients on [a, b] of the cubic B-spline with knots k0 <= .. <= k4, none of them strictly inside [a, b] in [k0, k4]:
/// coefficient i is the blossom f(a, .., a, b, .., b) with i times b.
std::array<double, 4> b_spline_on(const std::array<double, 5>& k, double a, double b);

}  // namespace tanktread::spline
