#pragma once
// From a degenerate bicubic Bezier element, one side of which is a pole, to bicubic elements without a degenerate side (P-A.1, P-A.2).

#include <array>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace tanktread::spline {

/// Bezier points of the degenerate element are Q_ij, u -> i fastest; the pole is the side u = 1. Those of the cubic triangle are T_ijk,
/// i + j + k = 3, of barycentric coordinates r = u (1 at the pole), s = (1 - u) v, t = (1 - u)(1 - v), in this order.
constexpr std::array<std::array<int, 3>, 10> triangle_points{
    {{0, 0, 3}, {1, 0, 2}, {2, 0, 1}, {3, 0, 0}, {0, 1, 2}, {1, 1, 1}, {2, 1, 0}, {0, 2, 1}, {1, 2, 0}, {0, 3, 0}}};

/// (P-A.1): the triangle that fits best. Row i of the degenerate element becomes a curve of degree 3 - i in v, by least squares with its
/// ends kept (Hu 2001); the pole is the mean of Q_30 .. Q_33. Shape (10, 16).
Eigen::MatrixXd triangle_of_degenerate();

/// (P-A.2): the triangle over the quadrilateral with the given corners (barycentric; (U, V) = (0,0), (1,0), (1,1), (0,1)), U fastest.
/// Exact, since a cubic over a bilinear map is bicubic. Shape (16, 10).
using Corners = std::array<Eigen::Vector3d, 4>;
Eigen::MatrixXd quadrilateral_of_triangle(const Corners& corners);

/// The three quadrilaterals between the corners, the mid-sides and the barycentre: at T_003, at the pole, at T_030.
const std::array<Corners, 3>& thirds_of_triangle();

/// One non-degenerate element.
struct PolePiece {
  double from = 0, to = 1;     ///< in v
  Corners corners;             ///< in the triangle over that
  Eigen::MatrixXd conversion;  ///< Bezier points of the piece = conversion * those of the degenerate element; shape (16, 16)

  /// Local coordinates of the place (u, v) of the degenerate element, if the piece's closure holds it. At the pole v means nothing.
  std::optional<std::array<double, 2>> local(double u, double v) const;
};

/// The degenerate element cut 2^subdivisions times in v, and each cut by (P-A.1) and (P-A.2): 3 * 2^subdivisions pieces.
std::vector<PolePiece> pole_pieces(int subdivisions);

}  // namespace tanktread::spline
