#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/SparseLU>

#include "surface/walls/outline.hpp"

namespace tanktread::surface {
namespace {

/// Linear system for the derivatives of an interpolating cubic spline at its knots.
class Rows {
 public:
  explicit Rows(int n) : n_(n), right_(Eigen::MatrixXd::Zero(n, 2)) {}
  void add(int row, int column, double value) { entries_.emplace_back(row, column, value); }
  void value(int row, const Vec2& value) { right_.row(row) = value; }

  Eigen::MatrixXd solution() const {
    Eigen::SparseMatrix<double> matrix(n_, n_);
    matrix.setFromTriplets(entries_.begin(), entries_.end());
    return Eigen::SparseLU<Eigen::SparseMatrix<double>>(matrix).solve(right_);
  }

 private:
  int n_;
  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::MatrixXd right_;
};

struct Step {
  double h;
  Vec2 slope;
};

std::vector<Step> steps(const std::vector<double>& breaks, const std::vector<Vec2>& points) {
  std::vector<Step> out;
  for (std::size_t e = 0; e + 1 < breaks.size(); ++e) {
    const double h = breaks[e + 1] - breaks[e];
    out.push_back({h, (points[(e + 1) % points.size()] - points[e]) / h});
  }
  return out;
}

/// Adds the equation that makes the second derivative continuous between the intervals `left` and `right`. `column`: columns of the unknown
/// derivatives at the three knots of these intervals.
void join(Rows& rows, int row, const Step& left, const Step& right, const std::array<int, 3>& column) {
  rows.add(row, column[0], 1 / left.h);
  rows.add(row, column[1], 2 / left.h + 2 / right.h);
  rows.add(row, column[2], 1 / right.h);
  rows.value(row, 3 * (left.slope / left.h + right.slope / right.h));
}

/// Adds the equation that makes the third derivatives on intervals k and k + 1 equal. If `vanishes`, makes the third derivative on interval k zero
/// instead.
void third_derivative(Rows& rows, int row, const std::vector<Step>& steps, int k, bool vanishes) {
  const Step& a = steps[k];
  const double one = 1 / (a.h * a.h);
  rows.add(row, k, one), rows.add(row, k + 1, one);
  Vec2 right = 2 * one * a.slope;
  if (!vanishes) {
    const Step& b = steps[k + 1];
    const double other = 1 / (b.h * b.h);
    rows.add(row, k + 1, -other), rows.add(row, k + 2, -other);
    right -= 2 * other * b.slope;
  }
  rows.value(row, right);
}

CubicCurve hermite(bool closed, const std::vector<double>& breaks, const std::vector<Vec2>& points, const Eigen::MatrixXd& derivatives) {
  CubicCurve curve{closed, breaks, {}};
  for (std::size_t e = 0; e + 1 < breaks.size(); ++e) {
    const std::size_t next = (e + 1) % points.size();
    const double third = (breaks[e + 1] - breaks[e]) / 3;
    const Vec2 d0 = derivatives.row(e), d1 = derivatives.row(next);
    curve.bezier.push_back({points[e], points[e] + third * d0, points[next] - third * d1, points[next]});
  }
  return curve;
}

/// Returns the cubic spline that interpolates the points. `ends`: function that adds the end conditions of an open spline to the system.
template <class Ends>
CubicCurve interpolate(bool closed, const std::vector<double>& breaks, const std::vector<Vec2>& points, const Ends& ends) {
  const std::vector<Step> step = steps(breaks, points);
  const int n = static_cast<int>(points.size()), m = static_cast<int>(step.size());
  Rows rows(n);
  for (int i = closed ? 0 : 1; i < m; ++i) join(rows, i, step[(i + m - 1) % m], step[i], {(i + n - 1) % n, i, (i + 1) % n});
  ends(rows, step, m);
  return hermite(closed, breaks, points, rows.solution());
}

PlaneJet jet(const Ellipse& e, double u) {
  const double c = std::cos(u), s = std::sin(u);
  const Vec2 x(e.semi_axes[0] * c, e.semi_axes[1] * s);
  return {e.centre + x, Vec2(-e.semi_axes[0] * s, e.semi_axes[1] * c), -x};
}

PlaneJet jet(const CubicCurve& curve, double u) {
  const double first = curve.breaks.front(), last = curve.breaks.back();
  if (curve.closed) u -= (last - first) * std::floor((u - first) / (last - first));
  const auto after = std::upper_bound(curve.breaks.begin() + 1, curve.breaks.end() - 1, u);
  const auto e = static_cast<std::size_t>(after - curve.breaks.begin() - 1);
  const double h = curve.breaks[e + 1] - curve.breaks[e], s = (u - curve.breaks[e]) / h, r = 1 - s;
  const auto& b = curve.bezier[e];
  const Vec2 d0 = b[1] - b[0], d1 = b[2] - b[1], d2 = b[3] - b[2];
  return {r * r * r * b[0] + 3 * r * r * s * b[1] + 3 * r * s * s * b[2] + s * s * s * b[3],
          (3 * r * r * d0 + 6 * r * s * d1 + 3 * s * s * d2) / h, (6 * r * (d1 - d0) + 6 * s * (d2 - d1)) / (h * h)};
}

/// Returns the blossom (polar form) of the cubic with the Bezier points b on [begin, end], at the three arguments t.
Vec2 blossom(std::array<Vec2, 4> b, double begin, double end, const std::array<double, 3>& t) {
  for (int level = 0; level < 3; ++level) {
    const double s = (t[level] - begin) / (end - begin);
    for (std::size_t i = 0; i + level < 3; ++i) b[i] = (1 - s) * b[i] + s * b[i + 1];
  }
  return b[0];
}

}  // namespace

bool closed(const PlaneCurve& curve) {
  const auto* cubic = std::get_if<CubicCurve>(&curve);
  return !cubic || cubic->closed;
}

std::array<double, 2> range(const PlaneCurve& curve) {
  const auto* cubic = std::get_if<CubicCurve>(&curve);
  return cubic ? std::array{cubic->breaks.front(), cubic->breaks.back()} : std::array{0.0, 2 * std::numbers::pi};
}

PlaneJet jet(const PlaneCurve& curve, double u) {
  return std::visit([u](const auto& c) { return jet(c, u); }, curve);
}

CubicCurve interpolate_closed(const std::vector<double>& breaks, const std::vector<Vec2>& points) {
  return interpolate(true, breaks, points, [](auto&&...) {});
}

CubicCurve interpolate_open(const std::vector<double>& breaks, const std::vector<Vec2>& points) {
  if (points.size() == 2) {
    const Vec2 slope = steps(breaks, points)[0].slope;
    return interpolate_open(breaks, points, slope, slope);
  }
  return interpolate(false, breaks, points, [](Rows& rows, const std::vector<Step>& step, int m) {
    third_derivative(rows, 0, step, 0, m == 2);
    third_derivative(rows, m, step, m == 2 ? 1 : m - 2, m == 2);
  });
}

CubicCurve interpolate_open(const std::vector<double>& breaks, const std::vector<Vec2>& points, const Vec2& first, const Vec2& last) {
  return interpolate(false, breaks, points, [&](Rows& rows, const std::vector<Step>&, int m) {
    rows.add(0, 0, 1), rows.value(0, first);
    rows.add(m, m, 1), rows.value(m, last);
  });
}

std::vector<Vec2> control_points(const CubicCurve& curve) {
  const int m = static_cast<int>(curve.bezier.size());
  const double period = curve.breaks.back() - curve.breaks.front();
  const auto knot = [&](int i) {
    if (!curve.closed) return curve.breaks[static_cast<std::size_t>(std::clamp(i, 0, m))];
    const int turn = i < 0 ? -1 : i >= m ? 1 : 0;
    return curve.breaks[i - turn * m] + turn * period;
  };
  std::vector<Vec2> out;
  for (int i = curve.closed ? 0 : -1; i < (curve.closed ? m : m + 2); ++i) {
    const auto e = static_cast<std::size_t>(std::clamp(i, 0, m - 1));
    out.push_back(blossom(curve.bezier[e], curve.breaks[e], curve.breaks[e + 1], {knot(i - 1), knot(i), knot(i + 1)}));
  }
  return out;
}

}  // namespace tanktread::surface
