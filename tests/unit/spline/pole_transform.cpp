#include "spline/polar.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "spline/bernstein.hpp"

namespace tanktread::spline {
namespace {

double in_basis(const Eigen::VectorXd& points, double u, double v) {
  double bu[4], bv[4], sum = 0;
  bernstein(3, u, bu);
  bernstein(3, v, bv);
  for (int b = 0; b < 16; ++b) sum += points[b] * bu[b % 4] * bv[b / 4];
  return sum;
}

/// Returns a degenerate element that is exactly a triangle: row i (u = const) has degree 3 - i in v.
Eigen::VectorXd affine_at_the_pole() {
  Eigen::VectorXd points(16);
  const Eigen::Vector4d base(0.3, -0.7, 1.1, 0.2);
  const Eigen::Vector3d next(0.9, 0.1, -0.4);
  const Eigen::Vector2d last(0.5, -0.2);
  const Eigen::VectorXd rows[4] = {base, elevation(2, 3) * next, elevation(1, 3) * last, Eigen::VectorXd::Constant(4, 0.6)};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) points[4 * j + i] = rows[i][j];
  return points;
}

TEST(PoleTransform, HasThePublishedEntries) {
  // Equation A.1 of Maestre et al. 2017, rows T111 and T300; equation A.2 of the first quadrilateral, its corner at the barycentre and its inner
  // points. Source: the appendix of that paper, after Hu, Comput. Aided Geom. Des. 18 (2001) and 13 (1996).
  const Eigen::MatrixXd triangle = triangle_of_degenerate();
  EXPECT_NEAR(triangle(5, 1), -0.25, 1e-15);
  EXPECT_NEAR(triangle(5, 5), 0.75, 1e-15);
  EXPECT_NEAR(triangle(5, 9), 0.75, 1e-15);
  EXPECT_NEAR(triangle(5, 13), -0.25, 1e-15);
  EXPECT_EQ(triangle(3, 7), 0.25);
  const Eigen::MatrixXd first = quadrilateral_of_triangle(thirds_of_triangle()[0]);
  EXPECT_NEAR(first(15, 5), 2. / 9, 1e-15);
  EXPECT_NEAR(first(15, 0), 1. / 27, 1e-15);
  EXPECT_NEAR(first(5, 0), 5. / 18, 1e-15);
  EXPECT_NEAR(first(5, 5), 1. / 6, 1e-15);
  EXPECT_NEAR(first(10, 5), 13. / 54, 1e-15);
  EXPECT_EQ(first(5, 9), 0);
}

TEST(PoleTransform, ReproducesConstantsAndQuadrilateralsAreAverages) {
  EXPECT_LT((triangle_of_degenerate().rowwise().sum().array() - 1).abs().maxCoeff(), 1e-15);
  for (const Corners& corners : thirds_of_triangle()) {
    const Eigen::MatrixXd m = quadrilateral_of_triangle(corners);
    EXPECT_LT((m.rowwise().sum().array() - 1).abs().maxCoeff(), 1e-14);
    EXPECT_GE(m.minCoeff(), 0);
  }
}

TEST(PoleTransform, ReproducesSurfacesWhoseRowNextToThePoleIsAffine) {
  const Eigen::VectorXd points = affine_at_the_pole();
  for (const int subdivisions : {0, 1, 2}) {
    int found = 0;
    for (const PolePiece& piece : pole_pieces(subdivisions)) {
      const Eigen::VectorXd own = piece.conversion * points;
      for (const double u : {0.0, 0.1, 0.33, 0.5, 0.77, 1.0})
        for (const double v : {0.0, 0.2, 0.5, 0.61, 1.0})
          if (const auto at = piece.local(u, v)) {
            EXPECT_NEAR(in_basis(own, (*at)[0], (*at)[1]), in_basis(points, u, v), 1e-13);
            ++found;
          }
    }
    EXPECT_GE(found, 30);  // every point is in at least one piece
  }
}

TEST(PoleTransform, ConvergesWithTheSquareOfTheAngleOfAPiece) {
  // A planar polar element, with u from the rim to the pole and v over a quarter circle.
  Eigen::VectorXd x(16);
  const double k = 4. / 3 * (std::sqrt(2.) - 1);  // parameter of the usual cubic approximation of a quarter circle
  const double arc[4] = {1, 1, k, 0};
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i) x[4 * j + i] = (3 - i) / 3. * arc[j];
  double before = 0;
  for (const int subdivisions : {1, 2, 3, 4}) {
    double error = 0;
    for (const PolePiece& piece : pole_pieces(subdivisions))
      for (const double u : {0.4, 0.6, 0.8})
        for (int n = 1; n < 64; n += 2)
          if (const auto at = piece.local(u, n / 64.))
            error = std::max(error, std::abs(in_basis(piece.conversion * x, (*at)[0], (*at)[1]) - in_basis(x, u, n / 64.)));
    if (before > 0) {
      EXPECT_NEAR(std::log2(before / error), 2, 0.3);
    }
    before = error;
  }
}

}  // namespace
}  // namespace tanktread::spline
