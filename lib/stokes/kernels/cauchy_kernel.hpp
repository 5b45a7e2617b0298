#pragma once
// Barycentric Cauchy sums: evaluate an analytic function from its values on a closed curve.

namespace tanktread::stokes {

/// Nodes on a closed curve, in arrays of length n: positions zeta = x + i y, line elements dzeta = dx + i dy (derivative of zeta times quadrature
/// weight), and values F = f + i g of the function.
struct CauchyNodes {
  int n;
  const double *x, *y, *dx, *dy, *f, *g;
};

/// Computes at n points z = x + i y inside the curve
///   F(z) = sum_j F_j c_j / sum_j c_j,   c_j = dzeta_j/(zeta_j - z),   F'(z) = sum_j (F_j - F) c_j/(zeta_j - z) / sum_j c_j        (2.17)
/// and stores f = Re F and, unless `fx` is null, fx = Re F', fy = -Im F' (the gradient of f). Accurate up to the curve and on it. A point that
/// coincides with a node is moved by 1e-14 times `scale`, a typical length of the curve.
void cauchy_sums(const CauchyNodes& nodes, double scale, int n, const double* x, const double* y, double* f, double* fx, double* fy);

}  // namespace tanktread::stokes
