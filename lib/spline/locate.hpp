#pragma once
// Search for the element that contains a parametric point.

#include "spline/space.hpp"
#include "spline/t_mesh.hpp"

namespace tanktread::spline {

/// A point of the parametric domain: a macro face (face of the cube, or the whole polar domain) and coordinates in [0, 1] along its sides. Face and
/// coordinates do not depend on the mesh.
struct ParametricPoint {
  int face = 0;
  double x = 0, y = 0;
};

/// Returns the parametric point of a lattice vertex (on the face of lowest index that contains it) or of a site (element and local coordinates).
ParametricPoint place(const Lattice& lattice, int vertex);
ParametricPoint place(const Space& space, const Site& site);

/// Returns, for every Bezier element, the index in elements(mesh) of the element of the T-mesh that contains it. A Bezier element is marked for
/// refinement by marking this T-mesh element.
std::vector<int> mesh_elements(const TMesh& mesh, const Space& space);

/// Finds the Bezier element of lowest index whose closure contains a parametric point. A locator is built once per space; the space must outlive
/// it.
class Locator {
 public:
  explicit Locator(const Space& space);
  Site operator()(const ParametricPoint& p) const;

 private:
  const Space& space_;
  int side_ = 1;                           // number of search buckets along a side of a face
  std::vector<std::vector<int>> buckets_;  // indices of the elements that overlap each search bucket, ascending
};

}  // namespace tanktread::spline
