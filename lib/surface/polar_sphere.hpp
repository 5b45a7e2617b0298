#pragma once
// The unit sphere on the structured mesh.

#include "base/types.hpp"
#include "spline/polar.hpp"
#include "spline/space.hpp"

namespace tanktread::surface {

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

}  // namespace tanktread::surface
