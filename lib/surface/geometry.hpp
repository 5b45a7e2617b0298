#pragma once
// Points, measures and moments of a spline surface. A surface is a space and a control net.

#include "base/types.hpp"
#include "spline/space.hpp"

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

/// Integral measures, by Gauss quadrature exact for the polynomials involved (volume, centroid, moments) or `order` points (area).
struct Measures {
  double area = 0, volume = 0;
  Vec3 centroid;       ///< P-43
  Mat3 second_moments; ///< M_ij = 1/5 oint y_i y_j (y.n) dG about the centroid (method.md, section 6)
};
Measures measures(const spline::Space& space, const Net& net);

/// V(x), and the flux vector b_A = int N_A n dG = dV/dx_A (2.8). Both are exact for polynomial elements.
double volume(const spline::Space& space, const Net& net);
Net volume_gradient(const spline::Space& space, const Net& net);

/// Semi-axes (descending), axes (columns) of the ellipsoid with the same second moments, a_i = sqrt(5 m_i / V).
struct Ellipsoid {
  Vec3 semi_axes;
  Mat3 axes;
};

/// What the series report (method.md, section 6). D in the x1 x3 plane; inclination in degrees.
struct Deformation {
  double taylor_inertia = 0, taylor_surface = 0, inclination = 0;
  Vec3 lengths;  ///< extents along x1, x2, x3
};
Deformation deformation(const spline::Space& space, const Net& net);

}  // namespace tanktread::surface
