#pragma once
// Points, measures and moments of a spline surface. A surface is a space and a control net.

#include <algorithm>
#include <array>
#include <limits>
#include <span>
#include <vector>

#include "base/types.hpp"
#include "spline/space.hpp"
#include "surface/bezier_points.hpp"
#include "surface/patch.hpp"

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

/// Returns whether two semi-axes of a body differ by at least 1e-6 R_C, where R_C is the radius of the sphere of equal volume. If they do not, each
/// direction between them is a semi-axis, and the computed one is round-off.
bool distinct(double longer, double shorter, double volume);

/// Semi-axes of the ellipsoid with the same second moments (6.1).
struct PrincipalAxes {
  Vec3 lengths = Vec3::Zero();     ///< in descending order
  Mat3 directions = Mat3::Zero();  ///< columns: unit vectors along the semi-axes; the first nonzero component of each is positive
  bool longest_defined = false;    ///< the longest and the middle semi-axis are distinct
  bool shortest_defined = false;   ///< the middle and the shortest semi-axis are distinct
};
PrincipalAxes principal_axes(const Measures& measures);

/// What measures are made of: area, volume, and integrals of x_i and x_i x_j (11, 22, 33, 12, 13, 23) about the mean of the control points.
constexpr int n_moments = 11;

// Extremal coordinates of a closed surface and extremal distances on a plane section, by Newton's method on the polynomials themselves.

struct Range {
  double smallest = std::numeric_limits<double>::infinity(), largest = -std::numeric_limits<double>::infinity();  ///< of nothing
};

/// Of two parts.
inline Range wider(const Range& a, const Range& b) { return {std::min(a.smallest, b.smallest), std::max(a.largest, b.largest)}; }

/// Smallest and largest coordinate x_{c+1} of the Bezier points, between which the patch stays.
Range hull(const Patch& patch, int c);

/// Smallest and largest coordinate x_{c+1} on the surface, to round-off. Of a whole surface, the wider of its parts.
Range coordinate_range(const Patches& surface, int c);

/// The place of the surface with the smallest coordinate x_{c+1}, to round-off.
Vec3 lowest(const Patches& surface, int c);

/// Shortest and longest distance of `centre` to the curve in which the plane x2 = centre_2 cuts the surface. To round-off where the surface
/// has a simple extremum; no symmetry is assumed. Of a whole surface, the wider of its parts; of nothing when the plane misses it.
Range section_distances(const Patches& surface, const Vec3& centre);

/// What the series report (6.2). D in the x1 x3 plane; inclination in degrees, from -90 (not included) to 90. The inclination is NaN if the two
/// semi-axes in that plane are not distinct.
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

  /// The derivative of int g.x dV, int N_A (g.x) n dG, exact; of these elements, added to b, complete as the flux vector is. x counts from `origin`.
  void add_moment_gradient(const Net& net, const Vec3& g, const Vec3& origin, std::span<const int> elements, Net& b) const;

  Measures measures(const Net& net) const;

  /// The same of each block of elements, block after block: those asked for, zero for the others; and measures from all.
  std::vector<double> block_moments(const Net& net, std::span<const int> blocks) const;
  static Measures measures(const Net& net, std::span<const double> of_blocks);

  int n_blocks() const { return surface::n_blocks(map_.n_elements()); }

  /// Both Taylor parameters in the x1 x3 plane, inclination and extents. Of inertia: from the second moments M_11, M_13, M_33; of the
  /// surface: from the longest and shortest distance of the centroid to the curve in which the plane x2 = centroid cuts the surface.
  /// Extremal points are found by Newton's method, to round-off.
  Deformation deformation(const Net& net) const;
  Deformation deformation(const Net& net, const Measures& measures) const;

  /// What it needs, of these elements: longest and shortest distance (0), extents (1, 2, 3); of all, the wider of parts. It throws RunFailure
  /// when the plane misses the surface.
  static constexpr int n_extremes = 4;
  std::array<Range, n_extremes> extremes(const Net& net, const Vec3& centroid, std::span<const int> elements) const;
  static Deformation deformation(const Measures& measures, const std::array<Range, n_extremes>& extremes);

 private:
  BezierMap map_;
  std::vector<int> all_, all_blocks_;  ///< 0 .. n_elements - 1, 0 .. n_blocks - 1
};

/// The same for a single use.
Measures measures(const spline::Space& space, const Net& net);
double volume(const spline::Space& space, const Net& net);

/// Velocity U of the centroid (P-42) of the interior of x when the net moves by v (6.4): exact.
Vec3 centroid_velocity(const BezierMap& map, const Net& x, const Net& v);

}  // namespace tanktread::surface
