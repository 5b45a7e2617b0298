#pragma once
// The surface around an extraordinary point of valence 3: either bi-quartic elements with continuous tangent planes (G1) across the mesh lines from
// the point, by constrained Bezier extraction, or the limit surface of Catmull-Clark subdivision in bicubic pieces.

#include <vector>

#include <Eigen/Core>

namespace tanktread::spline {

/// Indices of the 19 control points around an extraordinary point P. Each group has j = 0, 1, 2: the ends E_j of the three spokes (mesh lines from
/// P), the opposite corners F_j of the faces between spokes j and j + 1, and outside them A_j (beyond E_j), B_j (beyond F_j along spoke j), C_j
/// (diagonal) and D_j (beyond F_j along spoke j + 1).
struct OneRing {
  static constexpr int size = 19;
  static constexpr int P = 0, E = 1, F = 4, A = 7, B = 10, C = 13, D = 16;
};

/// Returns the bicubic Bezier points of face 0 by averaging, without any constraint at the extraordinary point P (C0 across the spokes, the mesh
/// lines from P). Shape (16, 19). Row 4 v + u is Bezier point (u, v), with u along spoke 0 and v along spoke 1. There is one column per point of
/// OneRing. The matrix of face j follows by a cyclic shift, by j, of the three columns of each group E, F, A, B, C and D.
Eigen::MatrixXd averaged_bicubic();

/// Returns the bi-quartic Bezier points of face 0, row 5 v + u. Shape (25, 19). Rows sum to 1.
///
/// c0 .. c3 are the control points of the cubic c(t) along a spoke (mesh line from the extraordinary point). c0, c2, c3 and all points that determine
/// the tangent planes on the outer sides of the faces keep their values, so the surface stays C1 there. c1 and the four inner points of each face
/// change such that the derivatives of the position x on both sides of the spoke satisfy
///
///   x_,v (right face) + x_,u (left face) = w0 (1 - t)^2 c'(t),   w0 = 2 cos(2 pi / 3)                                     (1.2)
///
/// and such that the Dirichlet energy of the change over the 5 x 5 Bezier points of all faces is smallest. This is the full least-squares form of the
/// extraction in reference [70] of the paper. The data published there lack the coefficients of the inner point (2, 2) for the outer control points
/// of OneRing, so that their rows do not sum to 1.
Eigen::MatrixXd constrained_biquartic();

/// Bicubic piece of face 0, which is the face between spokes 0 and 1 of an extraordinary point. The face is the unit square 0 <= u, v <= 1, with the
/// extraordinary point at u = v = 0.
struct Piece {
  double u, v, size;           ///< lower left corner, side
  Eigen::MatrixXd extraction;  ///< extraction matrix, shape (19, 16). Rows: control points in the order of OneRing. Column 4 j + i: Bernstein
                               ///< polynomial i in u times j in v
};

/// Returns 3 depth + 1 pieces of face 0: `depth` rings of three pieces with sides 1/2, 1/4, ... 2^-depth, which represent the limit surface exactly,
/// and one bicubic on the square of side 2^-depth at the extraordinary point, computed by averaged_bicubic(). Entries of the extraction matrices are
/// >= 0, and their columns sum to 1.
///
/// Masks (Catmull and Clark 1978): face point = mean of the corners; edge point = mean of the two ends and the two adjacent face points; vertex point
/// = (Q + 2 R + (N - 3) P) / N, with P the old vertex, N its valence, Q the mean of the adjacent face points and R the mean of the midpoints of its
/// edges. The surface is C1 at the extraordinary point, otherwise C2. The spaces of a mesh and of its refinement are nested if the squares with the
/// single bicubic have the same size on both meshes. If `depth` is the same on both meshes instead, the spaces are not nested, and refinement
/// changes the surface by an amount proportional to 0.41^depth.
std::vector<Piece> catmull_clark_pieces(int depth);

/// Returns the matrix of one subdivision: it maps the 19 control points of OneRing to the 19 control points of the ring with half the spacing. Shape
/// (19, 19).
Eigen::MatrixXd catmull_clark_subdivision();

}  // namespace tanktread::spline
