#pragma once
// The spline space of a T-mesh: Bezier elements, their extraction matrices and generalised Greville points.

#include <string>
#include <vector>

#include "spline/space.hpp"
#include "spline/t_mesh.hpp"

namespace tanktread::spline {

/// Rule by which the surface is represented on the faces around an extraordinary point.
enum class ExtraordinaryRule {
  g1,             ///< one bi-quartic element per face, with continuous tangent planes (G1; Maestre et al. 2017); not nested under refinement
  catmull_clark,  ///< limit surface of Catmull-Clark subdivision, in bicubic pieces that shrink towards the extraordinary point; nested under
                  ///< refinement
};

inline const std::vector<std::string> extraordinary_rules{"g1", "catmull-clark"};  ///< words for ExtraordinaryRule in decks

/// Returns the space of bicubic analysis-suitable T-splines of the mesh, with one function per anchor (vertex with a control point), in the order
/// of anchors(mesh). The positions of elements are in units of the side of a macro face (a face of the cube), so they do not depend on the
/// resolution of the mesh.
///
/// Regular elements have 16 functions, elements at an extraordinary point 19. Collocation point i is the generalised Greville point of anchor i:
/// the mean of its three inner knots in each direction. If the anchor is an extraordinary point, the collocation point is the extraordinary point.
Space space(const TMesh& mesh, ExtraordinaryRule rule);

}  // namespace tanktread::spline
