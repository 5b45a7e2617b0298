#include "spline/polar.hpp"

#include <cmath>

#include <Eigen/LU>
#include <Eigen/QR>
#include <unsupported/Eigen/KroneckerProduct>

#include "spline/bernstein.hpp"

namespace tanktread::spline {
namespace {

int index_of(int i, int j) {
  for (int b = 0; b < 10; ++b)
    if (triangle_points[b][0] == i && triangle_points[b][1] == j) return b;
  return -1;
}

/// Returns the matrix of degree reduction from 3 to q, shape (q + 1, 4). The ends are fixed, and the result, elevated to degree 3, is closest to the
/// given Bezier points in the least-squares sense.
Eigen::MatrixXd reduction(int q) {
  if (q == 0) return Eigen::MatrixXd::Constant(1, 4, 0.25);
  const Eigen::MatrixXd up = elevation(q, 3);
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(q + 1, 4);
  result(0, 0) = result(q, 3) = 1;
  if (q > 1) {
    Eigen::MatrixXd rest = Eigen::MatrixXd::Identity(4, 4);
    rest.col(0) -= up.col(0), rest.col(3) -= up.col(q);
    result.middleRows(1, q - 1) = up.middleCols(1, q - 1).colPivHouseholderQr().solve(rest);
  }
  return result;
}

Eigen::Vector3d place(const Corners& c, double U, double V) {
  return (1 - V) * ((1 - U) * c[0] + U * c[1]) + V * ((1 - U) * c[3] + U * c[2]);
}

double power(double x, int n) { return n == 0 ? 1 : x * power(x, n - 1); }

}  // namespace

Eigen::MatrixXd triangle_of_degenerate() {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(10, 16);
  for (int i = 0; i <= 3; ++i) {
    const Eigen::MatrixXd row = reduction(3 - i);
    for (int j = 0; j <= 3 - i; ++j)
      for (int k = 0; k < 4; ++k) result(index_of(i, j), 4 * k + i) = row(j, k);
  }
  return result;
}

Eigen::MatrixXd quadrilateral_of_triangle(const Corners& corners) {
  // Evaluates the cubic Bernstein polynomials of the triangle, with the factor 3!/(i! j! k!), at 4 x 4 points. Interpolates the values by bicubic
  // Bernstein polynomials.
  constexpr double factorial[4] = {1, 1, 2, 6};
  Eigen::MatrixXd values(16, 10);
  Eigen::VectorXd U(16), V(16);
  for (int q = 0; q < 16; ++q) {
    U[q] = (q % 4) / 3.0, V[q] = (q / 4) / 3.0;
    const Eigen::Vector3d r = place(corners, U[q], V[q]);
    for (int b = 0; b < 10; ++b) {
      const auto [i, j, k] = triangle_points[b];
      values(q, b) = 6 / (factorial[i] * factorial[j] * factorial[k]) * power(r[0], i) * power(r[1], j) * power(r[2], k);
    }
  }
  Eigen::MatrixXd result = tensor_bernstein(3, U, V).value.fullPivLu().solve(values);
  return result.unaryExpr([](double x) { return std::abs(x) < 1e-14 ? 0.0 : x; });
}

const std::array<Corners, 3>& thirds_of_triangle() {
  static const std::array<Corners, 3> thirds = [] {
    const Eigen::Vector3d r(1, 0, 0), s(0, 1, 0), t(0, 0, 1), centre = (r + s + t) / 3;
    return std::array<Corners, 3>{
        {{t, (r + t) / 2, centre, (s + t) / 2}, {r, (r + s) / 2, centre, (r + t) / 2}, {s, (s + t) / 2, centre, (r + s) / 2}}};
  }();
  return thirds;
}

std::optional<std::array<double, 2>> PolePiece::local(double u, double v) const {
  constexpr double margin = 1e-9;
  const bool pole = u > 1 - margin;
  const double within = pole ? 0.5 : (v - from) / (to - from);
  if (within < -margin || within > 1 + margin) return {};
  const Eigen::Vector2d wanted(u, (1 - u) * within);
  Eigen::Vector2d at(0.5, 0.5);
  for (int k = 0; k < 20; ++k) {  // Newton's method for the inverse of the bilinear map
    const Eigen::Vector3d dU = (1 - at[1]) * (corners[1] - corners[0]) + at[1] * (corners[2] - corners[3]);
    const Eigen::Vector3d dV = (1 - at[0]) * (corners[3] - corners[0]) + at[0] * (corners[2] - corners[1]);
    Eigen::Matrix2d slope;
    slope << dU[0], dV[0], dU[1], dV[1];
    at += slope.inverse() * (wanted - place(corners, at[0], at[1]).head<2>());
    at = at.cwiseMax(-0.5).cwiseMin(1.5);
  }
  // If the point is outside this PolePiece, the iteration may not converge to a solution (singular Jacobian, NaN).
  if (!((place(corners, at[0], at[1]).head<2>() - wanted).norm() <= margin)) return {};
  if (!(at.minCoeff() >= -margin && at.maxCoeff() <= 1 + margin)) return {};
  for (double& x : at) x = std::abs(x) < margin ? 0 : std::abs(x - 1) < margin ? 1 : x;
  return std::array<double, 2>{at[0], at[1]};
}

std::vector<PolePiece> pole_pieces(int subdivisions) {
  const int cuts = 1 << subdivisions;
  const Eigen::MatrixXd triangle = triangle_of_degenerate();
  std::vector<PolePiece> pieces;
  for (int k = 0; k < cuts; ++k) {
    const double from = double(k) / cuts, to = double(k + 1) / cuts;
    const Eigen::MatrixXd in_v = restriction(3, from, to);
    const Eigen::MatrixXd cut = Eigen::kroneckerProduct(in_v, Eigen::Matrix4d::Identity());
    for (const Corners& corners : thirds_of_triangle())
      pieces.push_back({from, to, corners, quadrilateral_of_triangle(corners) * triangle * cut});
  }
  return pieces;
}

}  // namespace tanktread::spline
