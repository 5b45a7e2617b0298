#pragma once
// The cross-section of a tube.

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "surface/options.hpp"

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

/// The nearest place of an outline to a point, and on which side of the outline the point is.
struct Nearest {
  int side = 0;
  double u = 0;
  Vec2 x;               ///< the place
  double distance = 0;  ///< to it; positive for a point inside the outline, negative outside
};

/// A closed curve without crossings in the plane x2 x3 (Vec2: x2, x3), counter-clockwise: x2 towards x3, seen against x1. Either one closed
/// smooth side, or several smooth sides that meet at corners, each starting where the one before ends.
class Outline {
 public:
  /// Throws UserError, a sentence that begins with `name`, for sides that cross or run clockwise.
  explicit Outline(std::vector<PlaneCurve> sides, const std::string& name = "The outline");

  int n_sides() const { return static_cast<int>(sides_.size()); }
  const PlaneCurve& side(int k) const { return sides_[static_cast<std::size_t>(k)]; }
  bool smooth() const { return closed(sides_[0]); }  ///< no corners

  PlaneJet at(int k, double u) const { return jet(side(k), u); }
  Vec2 point(int k, double u) const { return at(k, u).x; }
  Vec2 tangent(int k, double u) const { return at(k, u).d.normalized(); }
  Vec2 normal(int k, double u) const;  ///< unit, out of the tube's interior (into the wall)

  /// Angle inside the outline where side k begins, 0 .. 2 pi; pi where nothing turns.
  double corner_angle(int k) const;

  double length() const { return length_; }
  double side_length(int k) const { return lengths_[static_cast<std::size_t>(k)]; }
  double area() const { return area_; }
  Vec2 centroid() const { return centroid_; }
  double radius() const;                            ///< R_T = sqrt(area/pi)
  std::array<Vec2, 2> box() const { return box_; }  ///< smallest and largest coordinates

  Nearest nearest(const Vec2& p) const;
  double distance(const Vec2& p) const { return nearest(p).distance; }  ///< positive inside
  bool inside(const Vec2& p) const { return distance(p) > 0; }

  /// The nearest to p of the places that may be nearest to a point within r of x, whose own nearest place is `its`; the distance has no sign.
  Nearest nearest_around(const Vec2& x, const Nearest& its, double r, const Vec2& p) const;

  /// The number of elements of each side when `elements` are shared out by length, at least `least` on each, equally many on sides of one length:
  /// they may be a few more.
  std::vector<int> shares(int elements, int least = 1) const;

  /// m + 1 knots of m elements on side k, evenly in its parameter.
  std::vector<double> knots(int k, int m) const;

  /// The outline as cubic splines on shares(elements, 2) even elements: through the points at the knots, open sides with the end tangents as
  /// well. All sides of the result are CubicCurves; an order-4 approximation, exact for straight sides.
  Outline spline(int elements) const;

 private:
  /// Short chords of the sides, each with a bound on the curve's distance from it.
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

/// The section of a tube: circle and ellipse themselves, four straight sides, or the spline through the points of a file. Throws UserError.
Outline outline(const TubeOptions& options);

/// The same as cubic splines on `elements` elements.
inline Outline outline(const TubeOptions& options, int elements) { return outline(options).spline(elements); }

/// The outline through the points of a file, as `Tube/outline` describes it. Throws UserError: one sentence with file, line and numbers.
Outline read_outline(const std::string& path);

}  // namespace tanktread::surface
