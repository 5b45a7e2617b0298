#pragma once
// Control nets of resting and stress-free shapes, fitted with the order of accuracy of the space, and a smooth map from the surface of a cube to the
// sphere as a start for fits.

#include "base/types.hpp"
#include "spline/polar.hpp"
#include "spline/space.hpp"
#include "spline/t_mesh.hpp"
#include "surface/fit.hpp"
#include "surface/options.hpp"

namespace tanktread::surface {

/// Returns a point of the unit sphere for each control point of the mesh, as a start for fits: Catmull-Clark subdivision of a net of 3 x 3 elements
/// per face of the cube, projected radially onto the sphere. This map from the cube to the sphere is C2, also across the edges of the cube, except at
/// its eight corners. (An equiangular map has kinks along the cube edges, which smooth splines cannot represent; the error in the normal is ten times
/// as large.) The initial net divides the cube's edges in thirds. Its inner vertices lie at (0.26, 0.26, 1) before projection. This position gave the
/// smallest error in the normal for fitted spheres of 3 to 24 elements per side.
///
/// If the mesh is uniform with 3 * 2^k elements per side of the cube, the points are the vertices of the net after k subdivisions. Otherwise they are
/// points of the limit surface.
Net smooth_sphere(const spline::TMesh& mesh);

/// Returns the control points of the unit sphere. Starts with smooth_sphere(), and repeats `fits` times: fit the surface to its radial projection
/// x/|x| by least squares. The error in the radius falls with h^4, the error in the normal with h^2.7, where h is the element size. Both errors are
/// 10 to 40 per cent smaller than if the fits start with the cube projected onto the sphere.
Net unit_sphere(const spline::TMesh& mesh, const LeastSquaresFit& fit, int fits = 6);

/// Returns the control net of the unit sphere with its poles on the axis x_{axis+1}. The pole at x_{axis+1} = -1 comes first. `space`: spline space
/// of the mesh.
///
/// Each row of control points is a circle. The radii and heights of the circles minimise (by Gauss-Newton iteration)
///
///   int |grad eps|^2 + eps^2 dGamma,   eps = (|x|^2 - 1) / 2,
///
/// over the surface. grad eps is the part of x in the tangent plane, which is zero if the normal is exact. The minimum also optimises the
/// distribution of the elements along the meridian. Compared with a least-squares fit of positions, the error in the normal is 0.6 times as large,
/// and the error in the radius half as large.
Net unit_sphere(const spline::PolarMesh& mesh, const spline::Space& space, int axis = 2);

/// Coefficients c0, c1, c2 of the half thickness sqrt(1 - r^2)/2 (c0 + c1 r^2 + c2 r^4) of a red cell with unit radius (Evans & Fung 1972)
constexpr double red_cell_profile[] = {0.21, 2.0, -1.12};

/// Returns the biconcave disc of a red cell with unit radius and axis x3, as an image of the unit sphere:
///   (x1, x2, x3) -> (x1, x2, x3/2 (c0 + c1 r^2 + c2 r^4)),  r^2 = x1^2 + x2^2
Vec3 red_cell(const Vec3& on_unit_sphere);

/// Returns the control net of the resting shape `shape` at the centre and orientation set in the deck, from a fitted unit sphere. The result is not
/// rescaled, so its volume has the error of the fit. Lengths are in the unit of the deck.
Net resting_shape(const LeastSquaresFit& fit, const Net& unit_sphere, const ParticleShape& shape);

/// Returns the resting shape on the cube mesh, or on the structured mesh with its poles on the body-fixed axis x_{axis+1} of the particle.
Net resting_shape(const spline::Space& space, const spline::TMesh& mesh, const ParticleShape& shape);
Net resting_shape(const spline::Space& space, const spline::PolarMesh& mesh, int axis, const ParticleShape& shape);

/// Fits the resting shape `net` again by least squares on `space`, after refinement of its mesh. Returns a surface of the shape `file` or `cylinder`
/// unchanged.
Net fitted_again(const spline::Space& space, const Net& net, const ParticleShape& shape);

/// Converts the resting shape `net` of the particle `from` to the resting shape of the particle `to` on the same mesh. `to` may have another size,
/// position and orientation. Requires is_linear_image().
Net placed_again(const Net& net, const ParticleShape& from, const ParticleShape& to);

/// Returns true if placed_again() can convert the resting shape `from` to the resting shape `to`, because `to` is a linear image of `from`. Shapes
/// with different words are not compared: the result is false, even for a sphere and an ellipsoid.
bool is_linear_image(const ParticleShape& from, const ParticleShape& to);

/// Returns the control net of a stress-free oblate spheroid (a sphere if the reduced volume is 1) on the mesh of `unit_sphere`. The spheroid has the
/// area, the centre and the axis of the resting `shape`. Each point of the spheroid corresponds to the point of the resting shape at the same
/// azimuth, on the parallel that encloses the same area with the equator. So every part of the membrane has the same area in both shapes, and only
/// the form of the part differs.
///
/// The reduced volume v = 6 sqrt(pi) V/A^(3/2) is above 0 and at most 1. The shape must have an axis of revolution: a sphere (axis: body-fixed x3), a
/// spheroid, a red cell. Otherwise throws UserError.
Net stress_free_spheroid(const LeastSquaresFit& fit, const Net& unit_sphere, const ParticleShape& shape, double reduced_volume);

/// Returns the surface read from a file. Its centroid is moved to the centre given in the deck, and the surface is rotated about this centre.
Net imported_shape(const ParticleShape& shape);

}  // namespace tanktread::surface
