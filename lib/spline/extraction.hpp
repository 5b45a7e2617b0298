#pragma once
// From a T-mesh to a spline space: Bezier elements, their extraction matrices, generalised Greville sites.

#include "spline/space.hpp"
#include "spline/t_mesh.hpp"

namespace tanktread::spline {

/// What the surface is on the faces around an extraordinary point.
enum class ExtraordinaryRule {
  g1,             ///< bi-quartic, G1; the paper's. Its spaces are not nested under refinement at the point.
  catmull_clark,  ///< Catmull-Clark limit surface, cut into bicubic pieces towards the point; nested.
};

/// The space of bicubic analysis-suitable T-splines of the mesh: one function an anchor, in the order of anchors(mesh). Elements carry
/// their place in units of the side of a macro face, so places agree between meshes of different resolution.
///
/// Regular elements have 16 functions, elements at an extraordinary point 19. Collocation point i is the generalised Greville point of
/// anchor i: the means of its three inner knots in each direction; the extraordinary point itself for its own function.
Space space(const TMesh& mesh, ExtraordinaryRule rule);

}  // namespace tanktread::spline
