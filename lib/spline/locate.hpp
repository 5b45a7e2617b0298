#pragma once
// Which element holds a place of a macro face.

#include "spline/space.hpp"
#include "spline/t_mesh.hpp"

namespace tanktread::spline {

/// A place in the parametric domain: macro face, and coordinates in [0, 1] along its sides. The same in every mesh on the same faces,
/// however fine.
struct Place {
  int face = 0;
  double x = 0, y = 0;
};

/// Place of a lattice vertex (on the lowest face that holds it); of a site.
Place place(const Lattice& lattice, int vertex);
Place place(const Space& space, const Site& site);

/// For every Bezier element the element of elements(mesh) that holds it: what a mark for one of its Bezier elements marks.
std::vector<int> mesh_elements(const TMesh& mesh, const Space& space);

/// Finds the element of lowest number whose closure holds a place. Built once for a space, which must outlive it.
class Locator {
 public:
  explicit Locator(const Space& space);
  Site operator()(const Place& p) const;

 private:
  const Space& space_;
  int side_ = 1;                           // buckets along a side of a face
  std::vector<std::vector<int>> buckets_;  // elements that meet a bucket, ascending
};

}  // namespace tanktread::spline
