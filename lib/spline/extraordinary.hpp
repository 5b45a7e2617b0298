#pragma once
// The surface around an extraordinary point of valence 3: bi-quartic one-ring elements, G1 across the spokes, by constrained Bezier extraction; or
// the limit surface of Catmull and Clark's subdivision in bicubic pieces.

#include <vector>

#include <Eigen/Core>

namespace tanktread::spline {

/// The 19 points around an extraordinary point P, each group j = 0, 1, 2: spoke ends E_j, opposite corners F_j of the faces between spokes
/// j and j + 1, and outside them A_j (beyond E_j), B_j (beyond F_j along spoke j), C_j (diagonal), D_j (beyond F_j along spoke j + 1).
struct OneRing {
  static constexpr int size = 19;
  static constexpr int P = 0, E = 1, F = 4, A = 7, B = 10, C = 13, D = 16;
};

/// Bicubic Bezier points of face 0 without any constraint at P (C0 over the spokes), by averaging. Row 4 v + u, u along spoke 0, v along
/// spoke 1; column: point of the ring. Shape (16, 19). Face j: the columns of every group turned by j.
Eigen::MatrixXd averaged_bicubic();

/// Bi-quartic Bezier points of face 0, row 5 v + u. Shape (25, 19). Rows sum to 1.
///
/// The spoke cubics c0 .. c3 and all that the outer neighbours need for C1 keep their values; c1 and the four inner points of each face
/// move as little as they can, in the Dirichlet energy of the change over the 5 x 5 grid of every face, such that over spoke t -> c(t)
///
///   x_,v (right face) + x_,u (left face) = w0 (1 - t)^2 c'(t),   w0 = 2 cos(2 pi / 3)                                     (1.2)
///
/// This is the full least-squares form of the extraction of the paper's reference [70]; the published data leave out the inner point (2, 2)
/// for the outer points of the ring and so lose the partition of unity.
Eigen::MatrixXd constrained_biquartic();

/// One bicubic piece of face 0 of a one-ring (the point at u = v = 0, the face the unit square).
struct Piece {
  double u, v, size;           ///< lower left corner, side
  Eigen::MatrixXd extraction;  ///< shape (19, 16): points in the order of OneRing, column 4 j + i with i along u
};

/// `depth` rings of three pieces of sides 1/2, 1/4, ... 2^-depth, which are exactly the limit surface, and one averaged bicubic on the
/// square of side 2^-depth at the point: 3 depth + 1 pieces. Coefficients are >= 0 and columns sum to 1.
///
/// Masks (Catmull and Clark 1978): face = mean; edge = (two ends + two face points) / 4; vertex = (Q + 2 R + (N - 3) P) / N with Q the mean
/// of the face points and R that of the edge midpoints around it. C1 at the point, C2 elsewhere. Spaces are nested when the averaged square
/// has the same side in both (a *depth* counted from the face would not be: it changes the surface by 0.41^depth).
std::vector<Piece> catmull_clark_pieces(int depth);

/// One subdivision of the 19 points of the ring: the ring of half the spacing. Shape (19, 19).
Eigen::MatrixXd catmull_clark_subdivision();

}  // namespace tanktread::spline
