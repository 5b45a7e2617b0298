#include "surface/walls/outline.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>

#include <unistd.h>

#include "base/errors.hpp"
#include "spline/bernstein.hpp"
#include "tests/outlines.hpp"

namespace tanktread::surface {
namespace {

using std::numbers::pi;

TubeOptions tube(const char* section) {
  TubeOptions options;
  options.section = section;
  return options;
}

Outline circle(double radius) {
  TubeOptions options = tube("circle");
  options.radius = radius;
  return outline(options);
}

Outline ellipse(double a, double b) {
  TubeOptions options = tube("ellipse");
  options.semi_axes = Vec2(a, b);
  return outline(options);
}

Outline rectangle(double w, double h) {
  TubeOptions options = tube("rectangle");
  options.sides = Vec2(w, h);
  return outline(options);
}

TEST(CubicCurve, ThroughPointsOfACubicIsThatCubic) {
  const auto cubic = [](double u) { return Vec2(1 - 2 * u + u * u * u, 0.3 * u * u - u * u * u); };
  const auto slope = [](double u) { return Vec2(-2 + 3 * u * u, 0.6 * u - 3 * u * u); };
  const std::vector<double> breaks{-1, -0.4, 0.1, 0.9, 1.5, 2.1};
  std::vector<Vec2> points;
  for (const double u : breaks) points.push_back(cubic(u));
  for (const CubicCurve& curve : {interpolate_open(breaks, points), interpolate_open(breaks, points, slope(-1), slope(2.1))})
    for (const double u : {-1.0, -0.7, 0.1, 0.5, 1.7, 2.1}) {
      EXPECT_LT((jet(PlaneCurve(curve), u).x - cubic(u)).norm(), 1e-13);
      EXPECT_LT((jet(PlaneCurve(curve), u).d - slope(u)).norm(), 1e-12);
      EXPECT_LT((jet(PlaneCurve(curve), u).dd - Vec2(6 * u, 0.6 - 6 * u)).norm(), 1e-11);
    }
}

TEST(CubicCurve, IsTheSumOfItsControlPointsTimesBSplines) {
  const auto value = [](const CubicCurve& curve, double u) {  // by the definition of a B-spline, piece by piece
    const auto control = control_points(curve);
    const int m = static_cast<int>(curve.breaks.size()) - 1;
    const double period = curve.breaks.back() - curve.breaks.front();
    const auto knot = [&](int i) {
      if (!curve.closed) return curve.breaks[static_cast<std::size_t>(std::clamp(i, 0, m))];
      const int turn = i < 0 ? -1 : i >= m ? 1 : 0;
      return curve.breaks[static_cast<std::size_t>(i - turn * m)] + turn * period;
    };
    int e = 0;
    while (e + 1 < m && knot(e + 1) <= u) ++e;
    Vec2 x = Vec2::Zero();
    for (int middle = e - 1; middle <= e + 2; ++middle) {
      const auto b =
          spline::b_spline_on({knot(middle - 2), knot(middle - 1), knot(middle), knot(middle + 1), knot(middle + 2)}, knot(e), knot(e + 1));
      const double s = (u - knot(e)) / (knot(e + 1) - knot(e)), r = 1 - s;
      const int number = curve.closed ? (middle + m) % m : middle + 1;
      x += (b[0] * r * r * r + 3 * b[1] * r * r * s + 3 * b[2] * r * s * s + b[3] * s * s * s) * control[static_cast<std::size_t>(number)];
    }
    return x;
  };
  const std::vector<double> breaks{0, 0.5, 1.2, 1.5, 2.6, 3};
  const std::vector<Vec2> points{{1, 0}, {0.5, 1}, {-1, 0.7}, {-0.8, -0.5}, {0.1, -1}, {0.7, 2}};
  const CubicCurve open = interpolate_open(breaks, points), closed = interpolate_closed(breaks, {points.begin(), points.end() - 1});
  EXPECT_EQ(control_points(open).size(), 8u);
  EXPECT_EQ(control_points(closed).size(), 5u);
  for (const double u : {0.0, 0.2, 0.5, 1.3, 2.0, 2.9})
    for (const CubicCurve& curve : {open, closed}) EXPECT_LT((value(curve, u) - jet(PlaneCurve(curve), u).x).norm(), 1e-13);
  EXPECT_LT((jet(PlaneCurve(closed), 3 + 0.2).dd - jet(PlaneCurve(closed), 0.2).dd).norm(), 1e-12) << "a closed curve is periodic";
  EXPECT_LT((jet(PlaneCurve(closed), -1e-9).dd - jet(PlaneCurve(closed), 1e-9).dd).norm(), 1e-6) << "and C2 where it closes";
}

TEST(Outline, HasAreaCentroidLengthAndNormal) {
  const Outline e = ellipse(2, 0.5);
  EXPECT_NEAR(e.area(), pi, 1e-12);
  EXPECT_NEAR(e.radius(), 1, 1e-13);
  EXPECT_LT(e.centroid().norm(), 1e-13);
  EXPECT_NEAR(circle(3).length(), 6 * pi, 1e-11);
  EXPECT_LT((circle(2).normal(0, 0.3) - Vec2(std::cos(0.3), std::sin(0.3))).norm(), 1e-14);
  const Outline triangle = polygon({{0, 0}, {2, 0}, {0, 1}});
  EXPECT_NEAR(triangle.area(), 1, 1e-14);
  EXPECT_LT((triangle.centroid() - Vec2(2. / 3, 1. / 3)).norm(), 1e-14);
  EXPECT_LT((triangle.normal(0, 0.5) - Vec2(0, -1)).norm(), 1e-14);
  EXPECT_NEAR(triangle.corner_angle(0), pi / 2, 1e-14);
  EXPECT_NEAR(triangle.corner_angle(1), std::atan(0.5), 1e-14);
  EXPECT_NEAR(polygon({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}).corner_angle(3), 1.5 * pi, 1e-14) << "a corner that points inwards";
}

TEST(Outline, FindsTheNearestPointAndTheSide) {
  const std::vector<Outline> outlines{ellipse(2, 0.5), trefoil(40), rectangle(2, 1),
                                      polygon({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}})};
  for (const Outline& o : outlines)
    for (int i = 0; i < 60; ++i) {
      const Vec2 p(2.3 * std::sin(1.7 * i), 1.9 * std::cos(2.3 * i + 1));
      double least = 1e300, turns = 0;  // winding number, from the sum of the angles
      for (int k = 0; k < o.n_sides(); ++k) {
        const auto u = o.knots(k, 4000);
        for (std::size_t j = 0; j + 1 < u.size(); ++j) {
          const Vec2 a = o.point(k, u[j]) - p, b = o.point(k, u[j + 1]) - p;
          least = std::min(least, a.norm());
          turns += std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b));
        }
      }
      const Nearest n = o.nearest(p);
      EXPECT_LE(std::abs(n.distance), least + 1e-12);
      EXPECT_GE(std::abs(n.distance), least - 4e-3);  // half the spacing of the samples
      EXPECT_NEAR((n.x - p).norm(), std::abs(n.distance), 1e-13);
      EXPECT_LT((o.point(n.side, n.u) - n.x).norm(), 1e-13);
      EXPECT_EQ(o.inside(p), turns > pi) << p.transpose();
    }
}

TEST(Outline, DistinguishesInsideFromOutsideCloseToItself) {
  const std::vector<Outline> outlines{circle(1), trefoil(24), polygon({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}})};
  for (const Outline& o : outlines)
    for (int k = 0; k < o.n_sides(); ++k)
      for (const double u : o.knots(k, 37))
        for (const double d : {1e-2, 1e-6, 1e-10}) {
          const auto [first, last] = range(o.side(k));
          if (!o.smooth() && std::min(u - first, last - u) < 2 * d) continue;  // near a corner, the nearest point may be on another side
          EXPECT_NEAR(o.distance(o.point(k, u) - d * o.normal(k, u)), d, 1e-14);
          EXPECT_NEAR(o.distance(o.point(k, u) + d * o.normal(k, u)), -d, 1e-14);
        }
  const Outline square = rectangle(2, 2);
  EXPECT_NEAR(square.distance({1.3, 1.4}), -0.5, 1e-14) << "outside a corner";
  EXPECT_NEAR(square.distance({1 - 1e-9, 1 - 1e-9}), 1e-9, 1e-15) << "inside a corner";
}

TEST(Outline, IsApproachedByItsSplinesWithOrderFour) {
  const auto off = [](const Outline& exact, int n) {
    const Outline s = exact.spline(n);
    double most = 0;
    for (int k = 0; k < s.n_sides(); ++k)
      for (const double u : s.knots(k, 500)) most = std::max(most, std::abs(exact.distance(s.point(k, u))));
    return most;
  };
  EXPECT_NEAR(std::log2(off(ellipse(1, 0.5), 24) / off(ellipse(1, 0.5), 48)), 4, 0.2);
  EXPECT_LT(off(rectangle(2, 1), 13), 1e-15) << "straight sides are cubic";
  EXPECT_EQ(rectangle(2, 1).shares(12), (std::vector<int>{4, 2, 4, 2}));
  EXPECT_EQ(rectangle(6, 5).shares(21), (std::vector<int>{6, 5, 6, 5})) << "opposite sides have equally many";
}

TEST(Outline, RejectsSidesThatCrossOrRunClockwise) {
  const auto message = [](const std::vector<Vec2>& corners) {
    try {
      polygon(corners);
    } catch (const UserError& e) {
      return std::string(e.what());
    }
    return std::string();
  };
  EXPECT_EQ(message({{0, 0}, {1, 1}, {1, 0}, {0, 1}}), "The outline crosses itself near (x2, x3) = (0.5, 0.5).");
  EXPECT_EQ(message({{0, 0}, {0, 1}, {1, 0}}), "The outline must run counter-clockwise, from x2 towards x3, but runs clockwise.");
}

Outline of_file(const std::string& path) {
  TubeOptions options;
  options.section = "file";
  options.outline = {path};
  return outline(options);
}

/// A file that exists as long as the test.
class OutlineFile : public testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }

  Outline read(const std::string& text) const {
    std::ofstream(path_) << text;
    return of_file(path_);
  }

  /// Returns the error message after the name of the file.
  std::string refusal(const std::string& text) const {
    try {
      read(text);
    } catch (const UserError& e) {
      const std::string name = "Tube/outline \"" + path_ + "\"", what = e.what();
      EXPECT_EQ(what.rfind(name, 0), 0u) << what;
      return what.substr(std::min(name.size(), what.size()));
    }
    return "";
  }

  static std::string ring(int n, double last = 1) {
    std::string out;
    for (int i = 0; i < n * last; ++i)
      out += std::to_string(std::cos(2 * pi * i / n)) + ", " + std::to_string(std::sin(2 * pi * i / n)) + "\n";
    return out;
  }

  std::string path_ = (std::filesystem::temp_directory_path() / ("tanktread_outline_" + std::to_string(getpid()) + ".csv")).string();
};

TEST_F(OutlineFile, OfPointsOnACircleIsACircle) {
  const Outline o = read("# a comment\nx2,x3\n" + ring(48) + "\n");
  EXPECT_TRUE(o.smooth());
  EXPECT_NEAR(o.radius(), 1, 1e-5);  // order 4, and six digits in the file
  EXPECT_NEAR(o.distance({0.2, 0.1}), 1 - std::sqrt(0.05), 2e-5);
  EXPECT_NEAR(read(ring(48) + "1, 1e-9\n").area(), o.area(), 1e-14) << "the first point may stand at the end again";
}

TEST_F(OutlineFile, HasCornersWhereItMarksThem) {
  const Outline half = read("-1, 0, corner\n1, 0, corner\n0.7071067812, 0.7071067812\n0, 1\n-0.7071067812, 0.7071067812\n");
  EXPECT_EQ(half.n_sides(), 2);
  EXPECT_NEAR(half.side_length(0), 2, 1e-14);
  EXPECT_NEAR(half.area(), pi / 2, 0.01);  // an arc through five points
  const Outline drop = read("0,0,corner\n1,-0.5\n1.5,0\n1,0.5\n");
  EXPECT_EQ(drop.n_sides(), 1);
  EXPECT_FALSE(drop.smooth());
  EXPECT_TRUE(drop.inside({1, 0}));
  EXPECT_FALSE(drop.inside({-0.01, 0}));
  EXPECT_GT(drop.corner_angle(0), 0.5);
  EXPECT_LT(drop.corner_angle(0), pi);
  EXPECT_FALSE(read("0,0\n1,-0.5\n1.5,0\n1,0.5\n0,0,corner\n").smooth()) << "the mark may stand where the first point is repeated";
}

TEST_F(OutlineFile, IsRejectedWithTheReason) {
  EXPECT_EQ(refusal(ring(7)), " must hold at least 8 points without corners, but holds 7.");
  EXPECT_EQ(refusal("0,0,corner\n1,0\n"), " must hold at least 3 points, but holds 2.");
  const std::string expected = "; expected are 2 columns of numbers, x2, x3, and where it applies the word `corner`.";
  EXPECT_EQ(refusal("0,0\n1\n"), ", line 2, columns separated by commas: this row holds 1 number, but the first row 2" + expected);
  EXPECT_EQ(refusal("0,0\n1,2,3\n"), ", line 2, columns separated by commas: this row holds 3 numbers, but the first row 2" + expected);
  EXPECT_EQ(refusal("0,0\n1,2 m\n"), ", line 2, columns separated by commas: \"2 m\" is not a number" + expected);
  EXPECT_EQ(refusal("# one\n0,0,corner\n1,0\n1,0\n1,1\n0,1\n"), ", line 4: the point of line 3 is repeated here.");
  EXPECT_EQ(refusal(ring(40, 0.6)).substr(0, 50), " is open: its last point is 1.945 from its first, ");
  EXPECT_EQ(refusal("0,0,corner\n1,1,corner\n1,0,corner\n0,1,corner\n"), " crosses itself near (x2, x3) = (0.5, 0.5).");
  EXPECT_EQ(refusal("0,0,corner\n0,1,corner\n1,0,corner\n"), " must run counter-clockwise, from x2 towards x3, but runs clockwise.");
  EXPECT_THROW(of_file("no such file.csv"), UserError);
}

}  // namespace
}  // namespace tanktread::surface
