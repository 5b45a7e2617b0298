#pragma once
// Smooth curves in the plane x2 x3, the sides of an outline.

#include <array>
#include <variant>
#include <vector>

#include <Eigen/Core>

namespace tanktread::surface {

using Vec2 = Eigen::Vector2d;

/// A place on a curve with the first and second derivative by its parameter.
struct PlaneJet {
  Vec2 x, d, dd;
};

/// An ellipse (or circle) with its axes along x2 and x3; u is the eccentric angle, 0 .. 2 pi, counter-clockwise.
struct Ellipse {
  Vec2 centre, semi_axes;
};

/// A piecewise cubic curve, twice continuously differentiable: a cubic B-spline.
///   piece e, local 0 <= s = (u - breaks[e])/(breaks[e+1] - breaks[e]) <= 1:   x(s) = sum_i bezier[e][i] B_i(s)
struct CubicCurve {
  bool closed = false;                      ///< periodic: u = breaks.back() is u = breaks.front(), with equal derivatives
  std::vector<double> breaks;               ///< m + 1 ascending knots
  std::vector<std::array<Vec2, 4>> bezier;  ///< m pieces
};

/// One side of an outline: a closed curve, or an open one between two corners.
using PlaneCurve = std::variant<Ellipse, CubicCurve>;

bool closed(const PlaneCurve& curve);
std::array<double, 2> range(const PlaneCurve& curve);  ///< first and last parameter; a closed curve takes any u and is periodic
PlaneJet jet(const PlaneCurve& curve, double u);

/// The cubic spline with these knots that takes the given values there. Closed: points.size() = breaks.size() - 1, breaks.size() >= 4.
/// Open: points.size() = breaks.size() >= 2; the third derivative is continuous at the first and last inner knot (not-a-knot); two points
/// are a straight line, three a parabola.
CubicCurve interpolate_closed(const std::vector<double>& breaks, const std::vector<Vec2>& points);
CubicCurve interpolate_open(const std::vector<double>& breaks, const std::vector<Vec2>& points);

/// The open spline that also has the given derivatives by u at its ends.
CubicCurve interpolate_open(const std::vector<double>& breaks, const std::vector<Vec2>& points, const Vec2& first, const Vec2& last);

/// B-spline control points. Closed: m of them, number i belongs to the function with its middle knot at breaks[i]. Open (end knots fourfold): m + 3.
std::vector<Vec2> control_points(const CubicCurve& curve);

}  // namespace tanktread::surface
