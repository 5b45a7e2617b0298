#include "spline/bernstein.hpp"

#include <cassert>

namespace tanktread::spline {

namespace {

/// Replaces the values at x of the Bernstein polynomials of degree k - 1 by the values of the Bernstein polynomials of degree k.
void raise_degree(int k, double x, double* value) {
  const double y = 1 - x;
  double carried = 0;
  for (int i = 0; i < k; ++i) {
    const double old = value[i];
    value[i] = carried + y * old;
    carried = x * old;
  }
  value[k] = carried;
}

/// Computes d/dx B_i^p = p (B_{i-1}^{p-1} - B_i^{p-1}) from the values of degree p - 1.
void difference(int p, const double* lower, double* out) {
  out[0] = -p * lower[0];
  for (int i = 1; i < p; ++i) out[i] = p * (lower[i - 1] - lower[i]);
  out[p] = p * lower[p - 1];
}

}  // namespace

void bernstein(int p, double x, double* value) {
  value[0] = 1;
  for (int k = 1; k <= p; ++k) raise_degree(k, x, value);
}

void bernstein(int p, double x, double* value, double* first, double* second) {
  assert(p >= 1 && p <= most_polynomial_degree);
  if (p == 1) {
    value[0] = 1;
    if (second) second[0] = second[1] = 0;
  } else {
    bernstein(p - 2, x, value);
    if (second) {
      double slope[most_polynomial_degree + 1];
      difference(p - 1, value, slope);
      difference(p, slope, second);
    }
    raise_degree(p - 1, x, value);
  }
  difference(p, value, first);
  raise_degree(p, x, value);
}

TensorBernstein tensor_bernstein(int p, const Eigen::VectorXd& s, const Eigen::VectorXd& t) {
  const Eigen::Index n = p + 1;
  TensorBernstein all;
  for (Eigen::MatrixXd* const table : {&all.value, &all.s, &all.t}) table->resize(s.size(), n * n);
  double bs[most_polynomial_degree + 1], bt[most_polynomial_degree + 1], ds[most_polynomial_degree + 1], dt[most_polynomial_degree + 1];
  for (Eigen::Index q = 0; q < s.size(); ++q) {
    bernstein(p, s[q], bs, ds, nullptr);
    bernstein(p, t[q], bt, dt, nullptr);
    for (Eigen::Index b = 0; b < n * n; ++b) {
      const Eigen::Index i = b % n, j = b / n;
      all.value(q, b) = bs[i] * bt[j], all.s(q, b) = ds[i] * bt[j], all.t(q, b) = bs[i] * dt[j];
    }
  }
  return all;
}

Eigen::MatrixXd elevation(int p, int q) {
  Eigen::MatrixXd all = Eigen::MatrixXd::Identity(p + 1, p + 1);
  for (int r = p + 1; r <= q; ++r) {
    Eigen::MatrixXd one = Eigen::MatrixXd::Zero(r + 1, r);
    for (int i = 0; i <= r; ++i) {
      if (i < r) one(i, i) = double(r - i) / r;
      if (i > 0) one(i, i - 1) = double(i) / r;
    }
    all = one * all;
  }
  return all;
}

Eigen::MatrixXd restriction(int p, double a, double b) {
  // Row i is the blossom (polar form) of the Bernstein polynomials with i arguments equal to b and p - i equal to a.
  Eigen::MatrixXd out(p + 1, p + 1);
  for (int i = 0; i <= p; ++i) {
    Eigen::MatrixXd row = Eigen::MatrixXd::Identity(p + 1, p + 1);
    for (int r = 0; r < p; ++r) {
      const double x = r < p - i ? a : b;
      for (int k = 0; k < p - r; ++k) row.row(k) = (1 - x) * row.row(k) + x * row.row(k + 1);
    }
    out.row(i) = row.row(0);
  }
  return out;
}

std::array<double, 4> b_spline_on(const std::array<double, 5>& k, double a, double b) {
  const double K[11] = {k[0] - 3, k[0] - 2, k[0] - 1, k[0], k[1], k[2], k[3], k[4], k[4] + 1, k[4] + 2, k[4] + 3};
  int span = 3;
  while (span < 6 && K[span + 1] <= a) ++span;
  // De Boor's algorithm for the blossom (polar form) of the cubic. Each of its three steps uses a or b as its argument. The result of a step
  // depends only on how many of the arguments so far were b.
  double d[4][4][4] = {};  // d[r][n]: four coefficients after r steps, of which n used the argument b and r - n the argument a
  d[0][0][6 - span] = 1;
  for (int r = 1; r <= 3; ++r)
    for (int j = r; j < 4; ++j) {
      const int m = span - 3 + j;
      const double part = 1 / (K[m + 4 - r] - K[m]), x = (a - K[m]) * part, y = (b - K[m]) * part;
      for (int n = 0; n < r; ++n) d[r][n][j] = (1 - x) * d[r - 1][n][j - 1] + x * d[r - 1][n][j];
      d[r][r][j] = (1 - y) * d[r - 1][r - 1][j - 1] + y * d[r - 1][r - 1][j];
    }
  return {d[3][0][3], d[3][1][3], d[3][2][3], d[3][3][3]};
}

}  // namespace tanktread::spline
