#pragma once
// Cross-section of a tube.

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "base/types.hpp"
#include "surface/walls/duct_options.hpp"

namespace tanktread::surface {

using Vec2 = Eigen::Vector2d;

/// A point of a curve, with the first and second derivative with respect to its parameter.
struct PlaneJet {
  Vec2 x, d, dd;
};

/// An ellipse (or circle) with its axes along x2 and x3; u is the eccentric angle, 0 .. 2 pi, counter-clockwise.
struct Ellipse {
  Vec2 centre, semi_axes;
};

/// A piecewise cubic curve, twice continuously differentiable: a cubic B-spline.
///   On piece e, with the local parameter 0 <= s = (u - breaks[e])/(breaks[e+1] - breaks[e]) <= 1 and the cubic Bernstein polynomials B_i:
///   x(s) = sum_i bezier[e][i] B_i(s)
struct CubicCurve {
  /// true for a periodic curve: u = breaks.back() and u = breaks.front() are the same point, with equal derivatives; false for a curve with two ends
  bool closed = false;
  std::vector<double> breaks;               ///< m + 1 ascending knots
  std::vector<std::array<Vec2, 4>> bezier;  ///< m pieces
};

/// A smooth part of an outline: a closed curve, or an open one between two corners.
using PlaneCurve = std::variant<Ellipse, CubicCurve>;

bool closed(const PlaneCurve& curve);
std::array<double, 2> range(const PlaneCurve& curve);  ///< first and last parameter u; a closed curve is periodic and accepts any u
PlaneJet jet(const PlaneCurve& curve, double u);

/// Return the cubic spline with the knots `breaks` that interpolates the points. A closed spline requires points.size() = breaks.size() - 1 and
/// breaks.size() >= 4. An open spline requires points.size() = breaks.size() >= 2; its third derivative is continuous at the first and last inner
/// knot (not-a-knot). An open spline through two points is a straight line, through three points a parabola.
CubicCurve interpolate_closed(const std::vector<double>& breaks, const std::vector<Vec2>& points);
CubicCurve interpolate_open(const std::vector<double>& breaks, const std::vector<Vec2>& points);

/// Returns the open cubic spline that interpolates the points and has the given derivatives with respect to u at its two ends.
CubicCurve interpolate_open(const std::vector<double>& breaks, const std::vector<Vec2>& points, const Vec2& first, const Vec2& last);

/// Returns the B-spline control points. A closed curve with m pieces has m control points; point i belongs to the B-spline whose middle knot is
/// breaks[i]. An open curve (with fourfold end knots) has m + 3 control points.
std::vector<Vec2> control_points(const CubicCurve& curve);

/// The point of an outline nearest to a given point, with the index of its side and its parameter u on this side.
struct Nearest {
  int side = 0;
  double u = 0;
  Vec2 x;               ///< nearest point
  double distance = 0;  ///< distance of the given point from the outline; positive inside, negative outside
};

/// Closed curve without crossings in the plane x2 x3 (Vec2: x2, x3), traversed in the direction of rotation from x2 towards x3. The curve has either
/// one closed smooth side, or several smooth sides that meet at corners. Each side starts at the end of the previous side.
class Outline {
 public:
  /// Throws UserError if sides cross or run clockwise. `name`: name of the outline, with which the error message begins.
  explicit Outline(std::vector<PlaneCurve> sides, const std::string& name = "The outline");

  int n_sides() const { return static_cast<int>(sides_.size()); }
  const PlaneCurve& side(int k) const { return sides_[static_cast<std::size_t>(k)]; }
  bool smooth() const { return closed(sides_[0]); }  ///< no corners

  PlaneJet at(int k, double u) const { return jet(side(k), u); }
  Vec2 point(int k, double u) const { return at(k, u).x; }
  Vec2 tangent(int k, double u) const { return at(k, u).d.normalized(); }
  Vec2 normal(int k, double u) const;  ///< unit normal out of the tube's interior (into the wall)

  /// Returns the interior angle of the outline at the start of side k, in radians from 0 to 2 pi; pi if there is no corner.
  double corner_angle(int k) const;

  double length() const { return length_; }
  double side_length(int k) const { return lengths_[static_cast<std::size_t>(k)]; }
  double area() const { return area_; }
  Vec2 centroid() const { return centroid_; }
  double radius() const;                            ///< returns R_T = sqrt(area/pi)
  std::array<Vec2, 2> box() const { return box_; }  ///< lower and upper bounds of the coordinates, almost exact

  Nearest nearest(const Vec2& p) const;
  double distance(const Vec2& p) const { return nearest(p).distance; }  ///< positive inside
  bool inside(const Vec2& p) const { return distance(p) > 0; }

  /// Returns the point of the outline nearest to p. p must be within the distance r of x. `its`, the point of the outline nearest to x, limits the
  /// search. The distance in the result is not signed, whereas nearest() returns a negative distance if p is outside the outline.
  Nearest nearest_around(const Vec2& x, const Nearest& its, double r, const Vec2& p) const;

  /// Returns the number of elements of each side if `elements` elements are distributed in proportion to the lengths of the sides, with at least
  /// `least` per side and equally many on sides of equal length. The sum of these numbers may exceed `elements` slightly.
  std::vector<int> shares(int elements, int least = 1) const;

  /// Returns the m + 1 knots of m elements on side k, evenly spaced in the parameter of the side.
  std::vector<double> knots(int k, int m) const;

  /// Returns the outline as cubic splines on `elements` elements. shares() distributes the elements over the sides, with at least two per side, or
  /// three on a smooth outline; knots() gives the knots of each side. The splines interpolate the points at the knots and, on open sides, the
  /// tangents at the ends. All sides of the result are CubicCurves. The error is of order 4 in the element length, and zero for straight sides.
  Outline spline(int elements) const;

 private:
  /// The chord from a to b of a short part of a side, begin <= u <= end. `sag`: upper bound of the distance between the chord and this part.
  struct Chord {
    int side;
    double begin, end;
    Vec2 a, b;
    double sag;
  };
  const Chord& chord(int i) const { return chords_[static_cast<std::size_t>(i)]; }
  void add_chords(int k);
  void measure();
  std::optional<Vec2> first_crossing() const;
  static double distance_to(const Chord& chord, const Vec2& p);
  Nearest nearest_on(const Chord& chord, const Vec2& p) const;
  bool within(const Vec2& p, const Nearest& nearest) const;

  std::vector<PlaneCurve> sides_;
  std::vector<double> lengths_;
  std::vector<Chord> chords_;
  double length_ = 0, area_ = 0, sag_ = 0;
  Vec2 centroid_ = Vec2::Zero();
  std::array<Vec2, 2> box_;
};

/// Returns the cross-section of a tube: the exact circle or ellipse, the four straight sides of a rectangle, or the spline through the points of a
/// file, as described at `Tube/outline`. Throws UserError with a one-sentence message that names the file and, for a wrong line, its number.
Outline outline(const TubeOptions& options);

/// Returns the cross-section of a tube as cubic splines on `elements` elements.
inline Outline outline(const TubeOptions& options, int elements) { return outline(options).spline(elements); }

}  // namespace tanktread::surface
