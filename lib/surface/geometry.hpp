#pragma once
// Points, measures and moments of a spline surface. A surface is a space and a control net.

#include <span>

#include "base/types.hpp"
#include "spline/space.hpp"
#include "surface/bezier_points.hpp"

namespace tanktread::surface {

/// A point of the surface: place, tangents x_,s and x_,t (per element-local unit), outward unit normal, J = |a1 x a2|.
struct Point {
  Vec3 x, a1, a2, n;
  double jacobian = 0;
};
Point point(const spline::Space& space, const Net& net, const spline::Site& site);

/// Value of any field with control values `net` at a site.
Vec3 value(const spline::Space& space, const Net& net, const spline::Site& site);

/// Mean curvature chi = 1/2 div n (P-36); 1/R for a sphere. Units 1/length.
double mean_curvature(const spline::Space& space, const Net& net, const spline::Site& site);

/// Integral measures, by Gauss quadrature exact for the polynomials involved (volume, centroid, moments); the area by the same points.
struct Measures {
  double area = 0, volume = 0;
  Vec3 centroid;        ///< P-42
  Mat3 second_moments;  ///< M_ij = 1/5 oint y_i y_j (y.n) dG about the centroid (6.1)
};

/// Semi-axes (descending), axes (columns) of the ellipsoid with the same second moments, a_i = sqrt(5 m_i / V).
struct Ellipsoid {
  Vec3 semi_axes;
  Mat3 axes;
};
Ellipsoid ellipsoid_of_inertia(const Measures& measures);

/// What the series report (6.2). D in the x1 x3 plane; inclination in degrees.
struct Deformation {
  double taylor_inertia = 0, taylor_surface = 0, inclination = 0;
  Vec3 lengths;  ///< extents along x1, x2, x3
};

/// Measures of any number of control nets over one space, with what depends on the space alone made once.
/// Every sum runs in one fixed order of the elements, so a share of the elements gives the same rows to the last bit.
class Geometry {
 public:
  explicit Geometry(const spline::Space& space);

  const BezierMap& bezier() const { return map_; }

  /// V(x) = 1/3 oint x.n dG (P-43), exact for polynomial elements.
  double volume(const Net& net) const;

  /// The flux vector b_A = int N_A n dG = dV/dx_A (2.8), exact. Of these elements only: a row is complete when they hold all elements that
  /// touch its point. `b` is overwritten, shape (N, 3). The elements ascend.
  void volume_gradient(const Net& net, std::span<const int> elements, Net& b) const;
  Net volume_gradient(const Net& net) const;

  Measures measures(const Net& net) const;

  /// Both Taylor parameters in the x1 x3 plane, inclination and extents. Of inertia: from the second moments M_11, M_13, M_33; of the
  /// surface: from the longest and shortest distance of the centroid to the curve in which the plane x2 = centroid cuts the surface.
  /// Extremal points are found by Newton's method, to round-off.
  Deformation deformation(const Net& net) const;
  Deformation deformation(const Net& net, const Measures& measures) const;

 private:
  BezierMap map_;
  std::vector<int> all_;  ///< 0 .. n_elements - 1
};

/// The same for a single use.
Measures measures(const spline::Space& space, const Net& net);
double volume(const spline::Space& space, const Net& net);
Net volume_gradient(const spline::Space& space, const Net& net);
Deformation deformation(const spline::Space& space, const Net& net);

}  // namespace tanktread::surface
