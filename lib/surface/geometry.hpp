#pragma once
// Points, measures and moments of a spline surface, which is given by a space and a control net.

#include <array>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "spline/space.hpp"
#include "surface/bezier_points.hpp"
#include "surface/extremes.hpp"
#include "surface/patch.hpp"

namespace tanktread::surface {

/// A point of the surface: position, tangents a1 = x_,s and a2 = x_,t with respect to local coordinates, outward unit normal, area element J = |a1
/// x a2|.
struct Point {
  Vec3 x, a1, a2, n;
  double jacobian = 0;
};
Point point(const spline::Space& space, const Net& net, const spline::Site& site);

/// Returns the value of the field with control values `net` at a site (element and local coordinates).
Vec3 value(const spline::Space& space, const Net& net, const spline::Site& site);

/// Integral measures by Gauss quadrature. Volume, centroid and moments are exact for the polynomials involved; the area, whose integrand is not a
/// polynomial, is approximated with the same Gauss points.
struct Measures {
  double area = 0, volume = 0;
  Vec3 centroid;        ///< centroid of the enclosed volume
  Mat3 second_moments;  ///< M_ij = 1/5 oint y_i y_j (y.n) dGamma (6.1), with y the position relative to the centroid
};

/// Returns whether two semi-axes of a body differ by at least 1e-6 R_C, where R_C is the radius of the sphere of equal volume. If they do not, every
/// direction between them is a semi-axis, and the computed direction is determined by round-off.
bool distinct(double longer, double shorter, double volume);

/// Semi-axes of the ellipsoid with the same second moments (6.1) as the body.
struct PrincipalAxes {
  Vec3 lengths = Vec3::Zero();     ///< lengths of the semi-axes in descending order
  Mat3 directions = Mat3::Zero();  ///< columns: unit vectors along the semi-axes; the first nonzero component of each is positive
  /// whether the longest and the middle semi-axis differ enough to define the direction of the longest one
  bool longest_defined = false;
  /// whether the middle and the shortest semi-axis differ enough to define the direction of the shortest one
  bool shortest_defined = false;
};
PrincipalAxes principal_axes(const Measures& measures);

/// Number of integrals per block of elements: area, volume, and integrals of x_i and x_i x_j (11, 22, 33, 12, 13, 23) over the interior, with x
/// relative to the mean of the control points.
constexpr int n_moments = 11;

/// Deformation measures of the time series (6.2): Taylor parameter D in the x1 x3 plane, by two definitions (see Geometry::deformation());
/// inclination in degrees, from -90 (not included) to 90. The inclination is NaN if the two semi-axes in that plane are not distinct.
struct Deformation {
  double taylor_inertia = 0, taylor_surface = 0, inclination = 0;
  Vec3 lengths;  ///< extents along x1, x2, x3
};

/// Computes measures of any number of control nets on one space. Everything that depends only on the space is computed once. Every sum runs over the
/// elements in one fixed order. A gradient may be summed over a subset of the elements. If the subset includes all elements on which a basis function
/// is not zero, the row of the function's control point is bitwise equal to the row from all elements.
class Geometry {
 public:
  explicit Geometry(const spline::Space& space);

  const BezierMap& bezier() const { return map_; }

  /// Returns the volume V = 1/3 oint x.n dGamma, exactly. V is a homogeneous cubic function of the control points x, so V = x.(dV/dx)/3.
  double volume(const Net& net) const;

  /// Computes the flux vector b_A = dV/dx_A, the integral of N_A n over the surface (2.8), exactly, summed over the given elements in ascending
  /// order. The row of control point A is complete if the given elements include all elements on which N_A is not zero. `b` is overwritten, shape (N,
  /// 3).
  void volume_gradient(const Net& net, std::span<const int> elements, Net& b) const;
  Net volume_gradient(const Net& net) const;

  /// Adds to b the derivative of the volume integral of g.x with respect to the control points, which is the surface integral of N_A (g.x) n,
  /// exactly, summed over the given elements. x is relative to `origin`. The row of control point A is complete if the given elements include all
  /// elements on which N_A is not zero.
  void add_moment_gradient(const Net& net, const Vec3& g, const Vec3& origin, std::span<const int> elements, Net& b) const;

  Measures measures(const Net& net) const;

  /// Returns the n_moments integrals of each block of elements, one block after the other. They are computed for the given blocks and zero for the
  /// other blocks. measures() adds them up.
  std::vector<double> block_moments(const Net& net, std::span<const int> blocks) const;
  static Measures measures(const Net& net, std::span<const double> of_blocks);

  int n_blocks() const { return surface::n_blocks(map_.n_elements()); }

  /// Number of ranges (smallest and largest value) that extremes() returns for deformation(): distances of section points from the centroid (0),
  /// coordinates x1, x2, x3 (1, 2, 3). The ranges of a whole surface are the unions of the ranges of its parts. Extreme points are found by Newton's
  /// method, to round-off.
  static constexpr int n_extremes = 4;
  std::array<Range, n_extremes> extremes(const Net& net, const Vec3& centroid, std::span<const int> elements) const;

  /// Returns the inclination, the extents along x1, x2 and x3, and the Taylor parameter in the x1 x3 plane by two definitions. The first definition
  /// (inertia) uses the second moments M_11, M_13, M_33. The second definition (surface) uses the longest and shortest distance of the centroid to
  /// the curve in which the plane x2 = centroid_2 cuts the surface. Throws RunFailure if this plane does not intersect the surface.
  static Deformation deformation(const Measures& measures, const std::array<Range, n_extremes>& extremes);

 private:
  BezierMap map_;
  std::vector<int> all_, all_blocks_;  ///< all_: indices 0 .. n_elements - 1 of all elements. all_blocks_: indices 0 .. n_blocks - 1 of all blocks
};

/// Computes measures of one control net.
Measures measures(const spline::Space& space, const Net& net);
double volume(const spline::Space& space, const Net& net);

/// Returns exactly the velocity U (6.4) of the centroid of the volume enclosed by the surface x, if its control points move with velocity v.
Vec3 centroid_velocity(const BezierMap& map, const Net& x, const Net& v);

}  // namespace tanktread::surface
