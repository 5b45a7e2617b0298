#pragma once
// Control nets of resting shapes, fitted to the order of the space; a smooth way from the surface of a cube to the sphere, to start fits from.

#include "base/types.hpp"
#include "spline/polar.hpp"
#include "spline/space.hpp"
#include "spline/t_mesh.hpp"
#include "surface/fit.hpp"
#include "surface/options.hpp"

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

/// Unit sphere: the control points of a smooth cube sphere, then `fits` least-squares fits of the surface to its own radial image. The error in
/// the radius falls with h^4, in the normal with h^2.7; both are 10 to 40 per cent below those of a start from the projected cube.
Net unit_sphere(const spline::TMesh& mesh, const LeastSquaresFit& fit, int fits = 6);

/// Control net of the unit sphere whose poles lie on the axis x_{axis+1}, the pole ahead at +1. `space` is the one of the mesh.
///
/// All rows are circles, whose radii and heights are the minimum (Gauss and Newton) of
///
///   int |grad eps|^2 + eps^2 dG,   eps = (|x|^2 - 1) / 2,
///
/// over the surface itself, where grad eps is the part of x in the tangent plane, the error of the normal. The minimum takes the best
/// distribution of the elements along the meridian too: the error in the normal is 0.6 of that of a least-squares fit of places, in the
/// radius a half.
Net unit_sphere(const spline::PolarMesh& mesh, const spline::Space& space, int axis = 2);

/// c of the half thickness sqrt(1 - r^2)/2 (c0 + c1 r^2 + c2 r^4) of a red cell with unit radius       (Evans & Fung 1972)
constexpr double red_cell_profile[] = {0.21, 2.0, -1.12};

/// The biconcave disc of a red cell with unit radius and axis x3, as an image of the unit sphere:
///   (x1, x2, x3) -> (x1, x2, x3/2 (c0 + c1 r^2 + c2 r^4)),  r^2 = x1^2 + x2^2
Vec3 red_cell(const Vec3& on_unit_sphere);

/// The resting shape of a deck, in place, from a fitted unit sphere. Nothing is scaled after the fit, so the volume errs as the fit does; lengths
/// refer to the deck's radius.
Net resting_shape(const LeastSquaresFit& fit, const Net& unit_sphere, const ParticleShape& shape);

/// The same on the cube mesh, and on the structured one with its poles on the particle's own axis x_{axis+1}.
Net initial_shape(const spline::Space& space, const spline::TMesh& mesh, const ParticleShape& shape);
Net initial_shape(const spline::Space& space, const spline::PolarMesh& mesh, int axis, const ParticleShape& shape);

/// The resting shape `net` of an ellipsoid, in place, fitted again on the space that it is on by now; any other shape as it is.
Net fitted_again(const spline::Space& space, const Net& net, const ParticleShape& shape);

/// The resting shape `net` of one particle made into that of another on the same mesh, of another size, place and orientation.
Net placed_again(const Net& net, const ParticleShape& from, const ParticleShape& to);

/// The surface of a file, its centroid moved to the deck's centre and turned about it.
Net imported_shape(const ParticleShape& shape);

}  // namespace tanktread::surface
