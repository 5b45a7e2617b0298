#pragma once
// Catmull-Clark limit surface on the faces around an extraordinary point of valence 3, as bicubic pieces.

#include <vector>

#include <Eigen/Core>

namespace tanktread::spline {

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
