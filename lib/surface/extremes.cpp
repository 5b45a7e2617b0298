#include "surface/extremes.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/LU>

namespace tanktread::surface {
namespace {

using Vec2 = Eigen::Vector2d;
using Mat2 = Eigen::Matrix2d;
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Value, gradient and Hessian of sign * x_c (x_c: coordinate c) on a patch.
struct Height {
  double value;
  Vec2 gradient;
  Mat2 hessian;
};
Height height(const Patch& patch, int c, double sign, const Vec2& at) {
  const CoordinateJet j = jet(patch, c, at[0], at[1]);
  Height result{sign * j.x, sign * Vec2(j.s, j.t), {}};
  result.hessian << sign * j.ss, sign * j.st, sign * j.st, sign * j.tt;
  return result;
}

/// Returns a Newton step towards the maximum of h in the unit square. A coordinate on a side of the square is kept if the gradient points outwards
/// there. If the Newton step would decrease h, returns a steepest-ascent step.
Vec2 uphill(const Height& h, const Vec2& at) {
  const bool held[2] = {(at[0] <= 0 && h.gradient[0] <= 0) || (at[0] >= 1 && h.gradient[0] >= 0),
                        (at[1] <= 0 && h.gradient[1] <= 0) || (at[1] >= 1 && h.gradient[1] >= 0)};
  if (held[0] && held[1]) return Vec2::Zero();
  if (held[0] || held[1]) {
    const int free = held[0] ? 1 : 0;
    Vec2 step = Vec2::Zero();
    const double curvature = h.hessian(free, free), slope = h.gradient[free];
    step[free] = curvature < 0 ? -slope / curvature : std::copysign(0.25, slope);
    return step;
  }
  if (h.hessian(0, 0) < 0 && h.hessian.determinant() > 0) return -h.hessian.inverse() * h.gradient;
  return 0.25 * h.gradient / (h.gradient.norm() + std::numeric_limits<double>::min());
}

/// Newton's method stops after a step that is shorter than this, in local coordinates. The error is then of the order of the square of the step.
constexpr double converged = 1e-6;

/// Returns the local maximum of sign * x_c that an ascent from the point `at` of the patch reaches, and the parameters of the maximum. Shorter steps
/// than `converged` are Newton steps near the maximum. They are accepted without a comparison, because round-off exceeds the change of x_c.
std::pair<double, Vec2> summit(const Patch& patch, int c, double sign, Vec2 at) {
  Height here = height(patch, c, sign, at);
  for (int iteration = 0; iteration < 50; ++iteration) {
    Vec2 step = uphill(here, at);
    double moved = 0;
    for (int halving = 0; halving < 12; ++halving, step *= 0.5) {
      const Vec2 next = (at + step).cwiseMax(0).cwiseMin(1);
      const Height there = height(patch, c, sign, next);
      if (there.value < here.value && step.norm() > converged) continue;
      moved = (next - at).norm();
      at = next;
      here = there;
      break;
    }
    if (moved < 1e-9) break;  // the error of the place is of the order of the square of this step
  }
  return {here.value, at};
}

/// Returns the parameters of the point with the largest sign * x_c on the grid of sample(). This point is a start for summit(). The Bezier point with
/// the largest sign * x_c may be far from the maximum.
Vec2 start(const Patch& patch, int c, double sign) {
  const Grid<double> x = sample(patch, c);
  int highest = 0;
  const auto height = [&](int k) { return sign * x[k / (cells + 1)][k % (cells + 1)]; };
  for (int k = 1; k < (cells + 1) * (cells + 1); ++k)
    if (height(k) > height(highest)) highest = k;
  return Vec2(highest % (cells + 1), highest / (cells + 1)) / cells;
}

/// Returns the position with the largest sign * x_c on the surface, and this largest value. Elements with NaN are left out.
std::pair<Vec3, double> highest(const Patches& surface, int c, double sign) {
  std::pair<Vec3, double> best{Vec3::Zero(), -infinity};
  std::vector<std::pair<double, int>> bounds;  // upper bound of sign * x_c on each element that may exceed the corners found so far
  for (int e = 0; e < surface.size(); ++e) {
    const Patch& patch = surface[e];
    for (const int corner : {0, patch.degree, patch.n_bezier() - 1 - patch.degree, patch.n_bezier() - 1})
      if (const double here = sign * patch.coordinate(c, corner); here > best.second)
        best = {{patch.coordinate(0, corner), patch.coordinate(1, corner), patch.coordinate(2, corner)}, here};
    const Range range = hull(patch, c);
    if (const double bound = sign > 0 ? range.largest : -range.smallest; bound > best.second) bounds.emplace_back(bound, e);
  }
  std::ranges::sort(bounds, std::ranges::greater());
  for (const auto& [bound, e] : bounds) {
    if (bound <= best.second) break;
    const auto [value, at] = summit(surface[e], c, sign, start(surface[e], c, sign));
    if (value > best.second) best = {position(surface[e], at[0], at[1]), value};
  }
  return best;
}

/// Point of the section curve (the intersection of the surface with the plane x2 = centre_2) in one element.
struct Crossing {
  Vec2 at;
  double distance;
};

/// Moves a sampled point onto the section curve y2 = 0 (y = x - centre) along the gradient of y2. Returns the moved point and its distance from the
/// centre, or nothing if the iteration fails.
std::optional<Crossing> on_curve(const Patch& patch, const Vec3& centre, Vec2 at) {
  for (int iteration = 0; iteration < 10; ++iteration) {
    const CoordinateJet j = jet(patch, 1, at[0], at[1]);
    const Vec2 slope(j.s, j.t);
    const Vec2 step = -(j.x - centre[1]) / slope.squaredNorm() * slope;
    if (!(step.norm() < 1)) break;
    at = (at + step).cwiseMax(0).cwiseMin(1);
    if (step.norm() < converged) break;
  }
  const Vec3 y = position(patch, at[0], at[1]) - centre;
  if (!(std::abs(y[1]) < 1e-9 * y.norm())) return {};
  return Crossing{at, std::hypot(y[0], y[2])};
}

/// Returns points of the section curve: intersects the plane x2 = centre_2 with the chords of a sampling grid, and moves the intersections onto the
/// curve. Without the move, the errors of the distances from the centre may exceed the difference between the largest and the smallest distance on a
/// nearly circular curve.
std::vector<Crossing> crossings(const Patch& patch, const Vec3& centre) {
  std::vector<Crossing> result;
  Grid<double> above = sample(patch, 1);
  const double in_plane = 1e-13 * (position(patch, 0, 0) - centre).norm();  // sampled points nearer to the plane count as points of the plane
  for (auto& line : above)
    for (double& height : line)
      if (height -= centre[1]; std::abs(height) < in_plane) height = 0;
  const auto add = [&](double i, double j) {
    if (const auto found = on_curve(patch, centre, Vec2(i, j) / cells)) result.push_back(*found);
  };
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i) {
      const double here = above[j][i];
      if (here == 0) add(i, j);
      if (i < cells && here * above[j][i + 1] < 0) add(i + here / (here - above[j][i + 1]), j);
      if (j < cells && here * above[j + 1][i] < 0) add(i, j + here / (here - above[j + 1][i]));
    }
  return result;
}

/// Returns the stationary value of the distance from the centre on the section curve y2 = 0 (y = x - centre, r = |y|). Solves by Newton's method for
/// the point and lambda:
///
///   grad(r^2/2) = lambda grad(y2),   y2 = 0.
///
/// Returns nothing if the iteration leaves the element.
std::optional<double> stationary_distance(const Patch& patch, const Vec3& centre, Vec2 at) {
  double lambda = std::numeric_limits<double>::quiet_NaN();
  for (int iteration = 0; iteration < 15; ++iteration) {
    const Jet j = jet(patch, at[0], at[1]);
    const double y1 = j.x[0] - centre[0], y2 = j.x[1] - centre[1], y3 = j.x[2] - centre[2];
    const Vec2 pull(y1 * j.s[0] + y3 * j.s[2], y1 * j.t[0] + y3 * j.t[2]), slope(j.s[1], j.t[1]);
    if (std::isnan(lambda)) lambda = pull.dot(slope) / slope.squaredNorm();
    Mat3 system = Mat3::Zero();
    system(0, 0) = j.s[0] * j.s[0] + j.s[2] * j.s[2] + y1 * j.ss[0] + y3 * j.ss[2] - lambda * j.ss[1];
    system(0, 1) = j.s[0] * j.t[0] + j.s[2] * j.t[2] + y1 * j.st[0] + y3 * j.st[2] - lambda * j.st[1];
    system(1, 1) = j.t[0] * j.t[0] + j.t[2] * j.t[2] + y1 * j.tt[0] + y3 * j.tt[2] - lambda * j.tt[1];
    system(1, 0) = system(0, 1);
    system.block<2, 1>(0, 2) = -slope;
    system.block<1, 2>(2, 0) = slope.transpose();
    const Vec3 change = system.partialPivLu().solve(Vec3(-pull[0], -pull[1], -y2));
    Vec2 step = change.head<2>();
    const double length = step.norm();
    if (!(length < 1e3)) return {};
    if (length > 0.3) step *= 0.3 / length;
    at += step;
    lambda = change[2];
    if ((at.array() < -0.5).any() || (at.array() > 1.5).any()) return {};
    if (length < converged) break;
  }
  // tolerance, in local coordinates, for points outside the element; at a distance d outside, the polynomials of neighbouring elements differ by
  // O(d^3)
  constexpr double slack = 1e-7;
  if ((at.array() < -slack).any() || (at.array() > 1 + slack).any()) return {};
  const Vec3 y = position(patch, at[0], at[1]) - centre;
  if (!(std::abs(y[1]) < 1e-9 * y.norm())) return {};
  return std::hypot(y[0], y[2]);
}

/// An element that may contain an extremum of the distance from the centre, with sampled points of the section curve in ascending order of distance.
struct Candidate {
  int element;
  std::vector<Crossing> crossings;

  double spread() const { return crossings.back().distance - crossings.front().distance; }

  /// Returns the sampled point with the k-th largest value of sign * distance, k = 0 for the largest.
  const Crossing& best(double sign, std::size_t k = 0) const { return crossings[sign < 0 ? k : crossings.size() - 1 - k]; }
};

/// Searches for the maximum of d = sign * distance in all candidates that may contain it, and extends the range `found` by the distances found. On a
/// nearly circular curve, the search from a sampled maximum may converge to a minimum or leave the element. Then the search starts again from the
/// next sampled point. The margin of an element is a quarter of its spread, the largest minus the smallest sampled distance. An element is left out
/// if its largest sampled d is below the largest sampled d of all elements by more than the margin. A sampled point is left out if its d is below
/// the largest sampled d of its element by more than the margin. The margin is ample: if d is a parabola with its maximum inside the element, the
/// sampling error is at most spread/cells^2.
void add_distances(const Patches& surface, const Vec3& centre, const std::vector<Candidate>& candidates, double sign, Range& found) {
  double sampled = -infinity;
  for (const Candidate& c : candidates) sampled = std::max(sampled, sign * c.best(sign).distance);
  for (const Candidate& c : candidates) {
    const double best = c.best(sign).distance, slack = c.spread() / 4;
    if (sign * best + slack < sampled) continue;
    const auto add = [&](double distance) {
      found.smallest = std::min(found.smallest, distance), found.largest = std::max(found.largest, distance);
      return sign * (distance - best) >= -1e-12 * best;
    };
    add(best);
    for (std::size_t k = 0; k < c.crossings.size() && sign * (c.best(sign, k).distance - best) >= -slack; ++k) {
      const std::optional<double> distance = stationary_distance(surface[c.element], centre, c.best(sign, k).at);
      if (distance && add(*distance)) break;
    }
  }
}

}  // namespace

Range hull(const Patch& patch, int c) {
  const double* x = patch.points + c * patch.n_bezier();
  const auto [low, high] = std::minmax_element(x, x + patch.n_bezier());
  return {*low, *high};
}

Range coordinate_range(const Patches& surface, int c) { return {-highest(surface, c, -1).second, highest(surface, c, 1).second}; }

Vec3 lowest(const Patches& surface, int c) { return highest(surface, c, -1).first; }

Range section_distances(const Patches& surface, const Vec3& centre) {
  std::vector<Candidate> candidates;
  for (int e = 0; e < surface.size(); ++e) {
    const Patch& patch = surface[e];
    const auto [low, high] = hull(patch, 1);
    const double slack = 1e-12 * (std::abs(centre[1]) + high - low);
    if (low > centre[1] + slack || high < centre[1] - slack) continue;
    std::vector<Crossing> found = crossings(patch, centre);
    if (found.empty()) continue;
    std::ranges::sort(found, {}, &Crossing::distance);
    candidates.push_back({e, std::move(found)});
  }
  Range range;
  for (const double sign : {-1., 1.}) add_distances(surface, centre, candidates, sign, range);
  return range;
}

}  // namespace tanktread::surface
