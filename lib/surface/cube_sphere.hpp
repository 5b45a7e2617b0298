#pragma once
// A smooth way from the surface of a cube to the sphere, to start fits from.

#include "base/types.hpp"

namespace tanktread::surface {

/// Catmull-Clark subdivision of a net of 3 x 3 elements a face, drawn radially onto the unit sphere: C2 everywhere but at the eight corners,
/// cube edges included. (An equiangular map has kinks along the cube edges, which a smooth spline space smears out: ten times the error in the
/// normal.) The first net divides the cube's edges in thirds; its inner vertices lie at (0.26, 0.26, 1), where fitted spheres of 3 to 24 elements
/// a side were found to have the smallest error in the normal.
///
/// The surface has all symmetries of the cube, so one face suffices: what lies beyond its sides are its own mirror images.
class CubeSphere {
 public:
  /// `levels` subdivisions of the 3 x 3 net.
  explicit CubeSphere(int levels = 5);

  int elements_per_side() const { return n_; }

  /// Vertex (or bilinear interpolation between vertices) of the last net, on the unit sphere, for a point on the surface of the cube [-1, 1]^3.
  Vec3 net_point(const Vec3& on_cube) const;

  /// Point of the limit surface, on the unit sphere: a bicubic B-spline, exact but for the eight corner elements.
  Vec3 limit_point(const Vec3& on_cube) const;

 private:
  int n_;
  Net net_;  ///< vertices (i, j), -1 <= i, j <= n + 1, of the face x3 = 1, i fastest
};

}  // namespace tanktread::surface
