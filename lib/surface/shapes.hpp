#pragma once
// Control nets of resting shapes, fitted to the order of the space.

#include "base/types.hpp"
#include "spline/polar.hpp"
#include "spline/space.hpp"
#include "spline/t_mesh.hpp"
#include "surface/fit.hpp"
#include "surface/options.hpp"

namespace tanktread::surface {

/// Unit sphere: the control points of a smooth cube sphere, then `fits` least-squares fits of the surface to its own radial image. The error in
/// the radius falls with h^4, in the normal with h^2.7; both are 10 to 40 per cent below those of a start from the projected cube.
Net unit_sphere(const spline::TMesh& mesh, const LeastSquaresFit& fit, int fits = 6);

/// The biconcave disc of a red cell with unit radius and axis x3, as an image of the unit sphere:
///   (x1, x2, x3) -> (x1, x2, x3/2 (0.21 + 2.0 r^2 - 1.12 r^4)),  r^2 = x1^2 + x2^2        (Evans & Fung 1972)
Vec3 red_cell(const Vec3& on_unit_sphere);

/// The resting shape of a deck, in place, from a fitted unit sphere. Nothing is scaled after the fit, so the volume errs as the fit does; lengths
/// refer to the deck's radius.
Net resting_shape(const LeastSquaresFit& fit, const Net& unit_sphere, const ParticleShape& shape);

/// The same on the cube mesh, and on the structured one with its poles on the particle's own axis x_{axis+1}.
Net initial_shape(const spline::Space& space, const spline::TMesh& mesh, const ParticleShape& shape);
Net initial_shape(const spline::Space& space, const spline::PolarMesh& mesh, int axis, const ParticleShape& shape);

/// The resting shape `net` of an ellipsoid, in place, fitted again on the space that it is on by now; any other shape as it is.
Net fitted_again(const spline::Space& space, const Net& net, const ParticleShape& shape);

/// The surface of a file, its centroid moved to the deck's centre and turned about it.
Net imported_shape(const ParticleShape& shape);

}  // namespace tanktread::surface
