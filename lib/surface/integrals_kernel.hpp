#pragma once
// Integrals over elements from their Bezier points, vectorised: each lane of a SIMD register holds one element.

#include "base/pack.hpp"
#include "spline/limits.hpp"

namespace tanktread::surface::kernel {

constexpr int most_bezier = (spline::largest_degree + 1) * (spline::largest_degree + 1);

/// Bezier points, or derivatives with respect to them, of one element of degree p per lane: component c of point b in lane l is value[(c * (p+1)^2
/// + b) * pack_lanes() + l].
struct alignas(sizeof(double) * most_lanes) Lanes {
  double value[3 * most_bezier * most_lanes];
};

/// Computes the integral of B_b n over each element, the derivative of the volume with respect to Bezier point b. Exact, with (3p - 1)/2 + 1 Gauss
/// points per direction (p: degree).
void volume_gradient(int degree, const Lanes& x, Lanes& gradient);

/// Computes the integral of B_b (g.x) n over each element, the derivative of the integral of g.x over the interior with respect to Bezier point b.
/// Exact, with (4p - 1)/2 + 1 Gauss points per direction (p: degree).
void moment_gradient(int degree, const Lanes& x, const double* g, Lanes& gradient);

/// Contributions of each element to the area, and to the integrals of 1, x_i and x_i x_j (11, 22, 33, 12, 13, 23) over the interior: `volume`,
/// `first` and `second`. By the divergence theorem, these are surface integrals of (x.n)/3, x_i (x.n)/4 and x_i x_j (x.n)/5. They are exact, with (5p
/// - 1)/2 + 1 Gauss points per direction (p: degree); the area is not.
struct Moments {
  double area[most_lanes], volume[most_lanes], first[3][most_lanes], second[6][most_lanes];
};
void moments(int degree, const Lanes& x, Moments& result);

/// Integrals of v.n (`flux`) and x_i v.n (`flux_moment`) over each element, for a velocity v, and contributions of each element to `volume` and
/// `first` as in Moments. Exact, with (4p - 1)/2 + 1 Gauss points per direction (p: degree).
struct Transport {
  double volume[most_lanes], first[3][most_lanes], flux[most_lanes], flux_moment[3][most_lanes];
};
void transport(int degree, const Lanes& x, const Lanes& v, Transport& result);

/// Contributions of each element to the surface integrals of h_i h_j (`products`: upper triangle i <= j, row by row), h_i v.n (`motion`) and h_i n
/// (`normals`), for a velocity v. h_i are the 16 solid harmonics of degree 0 to 3; the first four are 1, x1, x2, x3. Three Gauss points per
/// direction.
constexpr int n_harmonics = 16;
struct ShapeMotion {
  double products[n_harmonics * (n_harmonics + 1) / 2][most_lanes], motion[n_harmonics][most_lanes], normals[n_harmonics][3][most_lanes];
};
void shape_motion(int degree, const Lanes& x, const Lanes& v, ShapeMotion& result);

}  // namespace tanktread::surface::kernel
