#pragma once
// One period of the surface of a solid that repeats on a lattice: a plate, or a cylinder along a lattice vector.

#include <array>
#include <vector>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "spline/space.hpp"

namespace tanktread::surface {

/// One period of a surface of solids. The geometry is an open spline surface. Densities on the surface are periodic splines with one coefficient per
/// collocation point in `sites`, and `open_from_periodic` maps these coefficients to control values on `space`. No collocation point lies where a
/// period begins or ends.
struct SolidSurface {
  spline::Space space;
  Net net;
  std::vector<std::vector<spline::Site>> sites;
  Eigen::SparseMatrix<double> open_from_periodic;
  /// numbers of equal elements along the two directions of a plate, each with one collocation point; {0, 0} for other surfaces. The collocation point
  /// with the indices (i, j) along the two directions is `sites`[i grid[1] + j]
  std::array<int, 2> grid{0, 0};

  int n_points() const { return static_cast<int>(sites.size()); }  ///< number of coefficients of a density
};

/// Returns one period of a plane through `middle`, spanned by two lattice vectors, with `elements` equal elements along each. The normal is along
/// first x second.
SolidSurface plate(const Vec3& middle, const Vec3& first, const Vec3& second, const std::array<int, 2>& elements);

/// Returns one period of a circular cylinder through `middle`, along the lattice vector `period`. The elements are equal: `around` elements around
/// the cylinder times `along` elements along it. The cross-section has the area pi radius^2. The normal points out of the cylinder.
SolidSurface cylinder(const Vec3& middle, const Vec3& period, double radius, int around, int along);

/// Returns the surfaces stacked into one. The indices of each surface follow the indices of the previous one.
SolidSurface stacked(const std::vector<SolidSurface>& surfaces);

}  // namespace tanktread::surface
