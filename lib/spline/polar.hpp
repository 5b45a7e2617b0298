#pragma once
// Structured closed surface: tensor product of a periodic cubic in azimuth and an open cubic along the meridian, with a pole at each end. Below,
// the pole at the beginning of the meridian is called "behind", the pole at its end "ahead".

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "spline/space.hpp"
#include "spline/t_mesh.hpp"

namespace tanktread::spline {

/// Representation of the surface around a pole.
enum class PoleRule {
  bezier_transform,  ///< functions of `plain`, but degenerate elements at the poles are replaced by non-degenerate pieces (equations A.1 and A.2 of
                     ///< Maestre et al. 2017)
  plain,             ///< one function per pole, only continuous (C0) there; elements at a pole have one side that is collapsed to the pole
  c1,                ///< three functions per pole, so that tangent planes are continuous; elements have a collapsed side as in `plain`
};

inline const std::vector<std::string> pole_rules{"bezier transform", "plain", "c1"};  ///< words for PoleRule in decks

struct PoleProperties {
  const char* name;        ///< name in Space::description
  int points;              ///< number of control points per pole, whose functions are not zero there
  int rows_replaced;       ///< number of rows of the tensor-product net that they replace: 1 for the row at the pole, 2 with the row next to it
  bool has_normal;         ///< the surface has a normal at the poles; otherwise loads and the identities of closed surfaces cannot be evaluated there
  bool replaces_elements;  ///< elements at the poles are replaced by pieces that are not elements of the mesh; spaces of nested meshes are not nested
};
PoleProperties properties(PoleRule rule);

/// Mesh of m elements in azimuth and r from pole to pole, with uniform knots. It has (r + 1) m + 2 control points, or (r - 1) m + 6 with `c1`.
struct PolarMesh {
  int azimuthal = 32;   ///< m >= 4
  int meridional = 16;  ///< r >= 4
  PoleRule poles = PoleRule::bezier_transform;
  int subdivisions = 2;  ///< with `bezier_transform`: degenerate elements are divided in azimuth into 2^subdivisions parts before they are replaced
};

/// Position of a control point at its generalised Greville point. In general, the control points are the two poles and rows of m points between them.
/// With PoleRule::c1, three control points per pole replace the pole and the row next to it.
///
/// u: coordinate along the meridian, in elements, from 0 (first pole, "behind") to r (last pole, "ahead"). v: azimuth, in elements. `distance`:
/// distance of the control point from the axis, divided by the radius of the row at u. It is 1 except for the three points per pole of PoleRule::c1.
struct PolarAnchor {
  double u = 0, v = 0, distance = 1;
};
std::vector<PolarAnchor> polar_anchors(const PolarMesh& mesh);

/// Returns the spline space of the mesh.
///
/// Order of control points: the pole at the beginning of the meridian ("behind"), the rows along the meridian (azimuth fastest), the pole at its end
/// ("ahead"). In an element, s runs along the azimuth and t along the meridian towards the pole ahead. Pieces that replace degenerate elements come
/// last. Element::face is 0. Element::origin and Element::size are fractions of the whole domain. The pieces of an element divide its size in
/// azimuth.
///
/// With PoleRule::plain, a pole is a collapsed side of m elements. The collocation point of the pole is at s = 1/2 on this side of each element.
///
/// With PoleRule::c1 (after Speleers and Toshniwal 2021), three functions N_k replace the functions N_0j of row 0, at the pole, and N_1j of row 1,
/// next to it. Let f_j = 2 pi j / m be the azimuths of the functions of a row, d_j = (cos f_j, sin f_j), and l_k the barycentric coordinates in a
/// triangle around all d_j. Then
///
///   N_k = l_k(0) sum_j N_0j + sum_j l_k(d_j) N_1j,   k = 0, 1, 2
///
/// Three of the d_j are the midpoints of the sides of the triangle. These three d_j are chosen such that the triangle is as large as possible. The
/// triangle then contains all d_j, so all l_k(d_j) >= 0. The collocation points of the three functions are the generalised Greville points of the
/// N_1j with these three d_j. The collocation matrix then has the condition number of tensor-product splines.
Space space(const PolarMesh& mesh);

/// Returns the space on a mesh made by polar() and then refined. It consists of analysis-suitable T-splines with one control point per anchor, except
/// at the poles. Control points are in the order of the lattice vertices.
///
/// With `c1`, the functions next to a pole have positions d_j in the tangent plane. On the initial mesh, the d_j are on the unit circle (see the
/// function above). On a finer mesh, knot insertion transfers the d_j to the new functions. Then they are multiplied by the ratio of the heights of
/// the elements at the pole in the finer and in the initial mesh, and a new triangle is chosen around them and the pole. This makes the spaces of
/// nested meshes nested. `plain` spaces are nested, too. `bezier_transform` spaces are not nested; fields are transferred between the `plain` spaces,
/// which have the same control points.
Space space(const TMesh& mesh, PoleRule poles, int subdivisions = 0);

// Conversion of a degenerate bicubic Bezier element, one side of which is a pole, to bicubic elements without a degenerate side (equations A.1 and
// A.2 of Maestre et al. 2017).

/// Indices (i, j, k), i + j + k = 3, of the Bezier points T_ijk of a cubic triangle, in the order in which the points are stored. The triangle
/// approximates a degenerate element with local coordinates u and v, whose side u = 1 is the pole. The barycentric coordinates are r = u,
/// s = (1 - u) v and t = (1 - u)(1 - v), with the exponents i, j and k in the Bernstein polynomial of T_ijk. The Bezier points of the degenerate
/// element are Q_ij, with i along u and j along v; i varies fastest.
constexpr std::array<std::array<int, 3>, 10> triangle_points{
    {{0, 0, 3}, {1, 0, 2}, {2, 0, 1}, {3, 0, 0}, {0, 1, 2}, {1, 1, 1}, {2, 1, 0}, {0, 2, 1}, {1, 2, 0}, {0, 3, 0}}};

/// Returns the matrix of equation A.1 of Maestre et al. 2017, shape (10, 16). The matrix maps the 16 Bezier points Q_ij of a degenerate element to
/// the 10 Bezier points T_ijk of the triangle that approximates the element best. The points Q_i0 .. Q_i3 define a cubic curve in v. For each i, this
/// curve is approximated by a curve of degree 3 - i by least squares with fixed ends (Hu 2001). The pole is the mean of Q_30 .. Q_33.
Eigen::MatrixXd triangle_of_degenerate();

/// Corners (U, V) = (0,0), (1,0), (1,1), (0,1) of a quadrilateral in a triangle, as barycentric coordinates with respect to the triangle.
using Corners = std::array<Eigen::Vector3d, 4>;
/// Returns the matrix of equation A.2 of Maestre et al. 2017, shape (16, 10). The matrix maps the control points of a cubic Bezier triangle to the
/// Bezier points of a bicubic quadrilateral in the triangle. The quadrilateral has the local coordinates U and V; Bezier points are numbered along U
/// first. The representation is exact, because barycentric coordinates are bilinear functions of U and V, and a cubic polynomial of bilinear
/// functions is bicubic.
Eigen::MatrixXd quadrilateral_of_triangle(const Corners& corners);

/// Returns the three quadrilaterals into which lines from the barycentre to the mid-sides divide a triangle with Bezier points T_ijk. Order: at the
/// corner T_003, at the corner T_300 (pole), at the corner T_030.
const std::array<Corners, 3>& thirds_of_triangle();

/// One of the non-degenerate Bezier elements that replace an element with a side at a pole.
struct PolePiece {
  double from = 0, to = 1;     ///< range of the local coordinate v (of the degenerate element) that the triangle of this piece covers
  Corners corners;             ///< corners of the piece, in barycentric coordinates of the triangle that contains it
  Eigen::MatrixXd conversion;  ///< maps Bezier points of the degenerate element to Bezier points of the piece; shape (16, 16)

  /// Returns the local coordinates on this piece of the point (u, v) of the degenerate element; returns nothing if the point is neither inside the
  /// piece nor on its boundary. At the pole v is ignored.
  std::optional<std::array<double, 2>> local(double u, double v) const;
};

/// Returns the 3 * 2^subdivisions pieces of a degenerate element: it is divided in v into 2^subdivisions parts, and equations A.1 and A.2 of Maestre
/// et al. 2017 convert each of them to three pieces.
std::vector<PolePiece> pole_pieces(int subdivisions);

}  // namespace tanktread::spline
