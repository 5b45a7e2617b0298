#pragma once
// The structured closed surface: a periodic cubic in azimuth times an open cubic along the meridian, with a pole at either end.

#include <array>
#include <optional>
#include <vector>

#include "spline/space.hpp"
#include "spline/t_mesh.hpp"

namespace tanktread::spline {

/// What the surface is around a pole.
enum class PoleRule {
  plain,             ///< one C0 function a pole; elements that are collapsed to the pole on one side
  bezier_transform,  ///< the same functions, their elements replaced by non-degenerate ones (pole_pieces); the paper's
  c1,                ///< three functions on a control triangle a pole, tangent planes continuous; elements as in `plain`
};

/// m elements around and r from pole to pole, uniform knots: (r + 1) m + 2 control points, or (r - 1) m + 6 under `c1`.
struct PolarMesh {
  int azimuthal = 32;   ///< m >= 4
  int meridional = 16;  ///< r >= 4
  PoleRule poles = PoleRule::bezier_transform;
  int subdivisions = 2;  ///< of the elements at the poles in azimuth before the transform, 2^subdivisions
};

/// Where a control point stands: way along the meridian in elements, from 0 (pole behind) to r (pole ahead), azimuth in elements, and distance
/// from the axis in that of its row. The generalised Greville places; the three of a pole under `c1` stand in for row 1 of the tensor net, at
/// other distances from the axis than that.
struct PolarAnchor {
  double u = 0, v = 0, distance = 1;
};
std::vector<PolarAnchor> anchors(const PolarMesh& mesh);

/// The space. Control points: the pole behind, rows along the meridian with azimuth fastest, the pole ahead. Elements: s along the azimuth,
/// t along the meridian towards the pole ahead; those of the transform last. A pole of `plain` lies on a whole side of m elements, and its
/// site is at s = 1/2 of each. `face` is 0 and `origin`, `size` are in parts of m and r; the pieces of the transform share the size.
///
/// Under `c1` (after Speleers and Toshniwal 2021), with rows 0 and 1 next to the pole, azimuths f_j = 2 pi j / m of their functions,
/// places d_j = (cos f_j, sin f_j), and l_k the barycentric coordinates in a triangle around all of them:
///
///   N_k = l_k(0) sum_j N_0j + sum_j l_k(d_j) N_1j,   k = 0, 1, 2
///
/// The triangle is the one that has three of the d_j as middles of its sides, which are chosen so that it is as large as they can make it (then it
/// holds them all, and l_k >= 0). The functions are collocated at the generalised Greville points of these three: condition numbers are those of
/// tensor-product splines.
Space space(const PolarMesh& mesh);

/// The same on a mesh made by polar() and refined: analysis-suitable T-splines, one control point an anchor but for those of a pole, in the order
/// of the lattice vertices.
///
/// Under `c1` the places of the base mesh are carried to the finer functions of row 1 by knot insertion, times the height of the first element over
/// that of the base mesh, so spaces of nested meshes are nested; the triangle is made anew from these places and the pole. `plain` spaces are nested
/// too; `bezier_transform` ones are not, but their control points are those of the `plain` space: take fields over between these.
Space space(const TMesh& mesh, PoleRule poles, int subdivisions = 0);

// From a degenerate bicubic Bezier element, one side of which is a pole, to bicubic elements without a degenerate side (P-A.1, P-A.2).

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
