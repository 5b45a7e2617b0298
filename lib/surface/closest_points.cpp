#include "surface/closest_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <queue>
#include <utility>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "base/indices.hpp"

namespace tanktread::surface {

namespace {

using Box = ElementBoxes::Box;
using Points = Eigen::Matrix3Xd;

Points bezier_points(const Patch& patch) {
  return Eigen::Map<const Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>>(patch.points, 3, patch.n_bezier());
}

/// Part of an element, given by its Bezier points, s fastest. The first call of halves() divides the part across its longer direction; later calls
/// return the stored halves.
struct Part {
  int degree = 0;
  Points points;
  spline::Site low{};                       // site of its first point
  std::array<double, 2> sides{1, 1};        // lengths of the part along s and t, as fractions of the element
  mutable std::shared_ptr<const std::array<Part, 2>> halves_kept{};

  double size() const { return (corner(1, 1) - corner(0, 0)).cwiseAbs().maxCoeff() + (corner(1, 0) - corner(0, 1)).cwiseAbs().maxCoeff(); }
  Vec3 corner(int i, int j) const { return points.col(degree * (i + (degree + 1) * j)); }
  spline::Site site(int i, int j) const { return {low.element, low.s + i * sides[0], low.t + j * sides[1]}; }  // site of a corner
  Vec3 middle() const { return points.rowwise().mean(); }
  Vec3 normal() const { return (corner(1, 1) - corner(0, 0)).cross(corner(0, 1) - corner(1, 0)).normalized(); }  // approximate normal at the middle

  const std::array<Part, 2>& halves() const {
    if (!halves_kept) halves_kept = std::make_shared<const std::array<Part, 2>>(halved());
    return *halves_kept;
  }

 private:
  /// Divides the part into two halves by de Casteljau's algorithm.
  std::array<Part, 2> halved() const {
    const int p = degree, n = p + 1;
    const bool along_s = (corner(1, 0) - corner(0, 0)).squaredNorm() + (corner(1, 1) - corner(0, 1)).squaredNorm() >
                         (corner(0, 1) - corner(0, 0)).squaredNorm() + (corner(1, 1) - corner(1, 0)).squaredNorm();
    const int step = along_s ? 1 : n, across = along_s ? n : 1;
    std::array<Part, 2> result{Part{degree, points, low, sides}, Part{degree, points, low, sides}};
    // `right` is computed in place: after step k of de Casteljau's algorithm, the first p - k + 1 points of a row hold the results of step k
    auto& [left, right] = result;
    left.sides[along_s ? 0 : 1] /= 2, right.sides = left.sides;
    (along_s ? right.low.s : right.low.t) += left.sides[along_s ? 0 : 1];
    for (int row = 0; row < n; ++row)
      for (int k = 1; k <= p; ++k) {
        for (int i = 0; i <= p - k; ++i) {
          const int at = row * across + i * step;
          right.points.col(at) = 0.5 * (right.points.col(at) + right.points.col(at + step));
        }
        left.points.col(row * across + k * step) = right.points.col(row * across);
      }
    return result;
  }
};

/// Returns the distance between the projections of two point sets on a unit vector that points from the first set to the second; negative if the
/// projections overlap.
double separation(const Points& a, const Points& b, const Vec3& direction) {
  return (direction.transpose() * b).minCoeff() - (direction.transpose() * a).maxCoeff();
}

class PairSearch {
 public:
  PairSearch(const ElementBoxes& first, const ElementBoxes& second, double tolerance, double beyond)
      : trees_{&first, &second}, tolerance_(tolerance) {
    best_.gap = beyond;
  }

  ClosestPoints nearest() {
    push({trees_[0]->whole().exteriorDistance(trees_[1]->whole()), {0, 0}, {}});
    while (!queue_.empty() && queue_.top().bound < best_.gap - tolerance_) {
      const Pair pair = queue_.top();
      queue_.pop();
      pair.part[0] ? open_parts(pair) : open_boxes(pair);
    }
    return best_;
  }

 private:
  /// A pair of bounding boxes, or if each box contains only one element, of parts of these elements.
  struct Pair {
    double bound;
    int box[2];
    const Part* part[2];
    bool operator<(const Pair& other) const { return bound > other.bound; }  // the pair with the smallest bound is at the top of the priority queue
  };

  void push(const Pair& pair) {
    if (pair.bound < best_.gap - tolerance_) queue_.push(pair);
  }

  const Box& box(const Pair& pair, int k) const { return trees_[k]->boxes()[pair.box[k]]; }
  bool single(const Pair& pair, int k) const { return box(pair, k).last - box(pair, k).first == 1; }

  void open_boxes(const Pair& pair) {
    if (single(pair, 0) && single(pair, 1)) {
      Pair parts = pair;
      for (int k = 0; k < 2; ++k) parts.part[k] = &whole(k, trees_[k]->element(box(pair, k).first));
      parts.bound = bound(parts);
      return push(parts);
    }
    const auto extent = [&](int k) { return single(pair, k) ? -1 : box(pair, k).bounds.sizes().maxCoeff(); };
    const int opened = extent(0) > extent(1) ? 0 : 1;
    for (const int child : box(pair, opened).child) {
      Pair next = pair;
      next.box[opened] = child;
      next.bound = box(next, 0).bounds.exteriorDistance(box(next, 1).bounds);
      push(next);
    }
  }

  void open_parts(const Pair& pair) {
    const int opened = pair.part[0]->size() > pair.part[1]->size() ? 0 : 1;
    for (const Part& half : pair.part[opened]->halves()) {
      Pair next = pair;
      next.part[opened] = &half;
      meet(*next.part[0], *next.part[1]);
      next.bound = std::max(pair.bound, bound(next));
      push(next);
    }
  }

  /// Replaces the closest pair of points found so far if two corners of the parts are closer. Corners are points of the surfaces. Newton's method
  /// then moves the points along the surfaces, because corners that are not opposite to each other have a distance that is too large by a multiple
  /// of the square of their offset.
  void meet(const Part& a, const Part& b) {
    bool closer = false;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        const Vec3 x = a.corner(i % 2, i / 2), y = b.corner(j % 2, j / 2);
        if (const double gap = (y - x).norm(); gap < best_.gap) best_ = {x, y, gap, {a.site(i % 2, i / 2), b.site(j % 2, j / 2)}}, closer = true;
      }
    if (!closer) return;
    const ClosestPoints moved = nearest_points(trees_[0]->surface()[a.low.element], trees_[1]->surface()[b.low.element], best_);
    const auto inside = [](const spline::Site& at) { return std::min(at.s, at.t) >= 0 && std::max(at.s, at.t) <= 1; };
    if (moved.gap < best_.gap && inside(moved.sites[0]) && inside(moved.sites[1])) best_ = moved;
  }

  double bound(const Pair& pair) const {
    const Part &a = *pair.part[0], &b = *pair.part[1];
    const Vec3 between = b.middle() - a.middle();
    double most = 0;
    for (Vec3 direction : {between, a.normal(), b.normal(), Vec3(best_.second - best_.first)}) {
      const double length = direction.norm();
      if (!(length > 0)) continue;
      direction *= (direction.dot(between) < 0 ? -1 : 1) / length;
      most = std::max(most, separation(a.points, b.points, direction));
    }
    return most;
  }

  const Part& whole(int k, int element) {
    Part& part = elements_[k][element];
    const Patch& patch = trees_[k]->surface()[element];
    if (part.points.size() == 0) part.degree = patch.degree, part.points = bezier_points(patch), part.low.element = element;
    return part;
  }

  const ElementBoxes* trees_[2];
  double tolerance_;
  std::priority_queue<Pair> queue_;
  std::map<int, Part> elements_[2];  // elements examined so far
  ClosestPoints best_{Vec3::Zero(), Vec3::Zero()};
};

}  // namespace

ElementBoxes::ElementBoxes(const Patches& surface, std::vector<int> elements)
    : surface_(surface), order_(elements.empty() ? indices(surface.size()) : std::move(elements)) {
  for (int e = 0; e < surface.size(); ++e) {
    const Points points = bezier_points(surface[e]);
    own_.emplace_back(Vec3(points.rowwise().minCoeff()), Vec3(points.rowwise().maxCoeff()));
  }
  split(0, static_cast<int>(order_.size()));
}

int ElementBoxes::split(int first, int last) {
  Box box{{}, first, last};
  for (int k = first; k < last; ++k) box.bounds.extend(own_[order_[k]]);
  const int number = static_cast<int>(boxes_.size());
  boxes_.push_back(box);
  if (last - first == 1) return number;
  int longest;
  box.bounds.sizes().maxCoeff(&longest);
  const int middle = first + (last - first) / 2;
  const auto centre = [&](int e) { return own_[e].min()[longest] + own_[e].max()[longest]; };
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last, [&](int a, int b) { return centre(a) < centre(b); });
  const int left = split(first, middle), right = split(middle, last);
  boxes_[number].child[0] = left;
  boxes_[number].child[1] = right;
  return number;
}

ClosestPoints closest_points(const ElementBoxes& first, const ElementBoxes& second, double tolerance, double beyond) {
  return PairSearch(first, second, tolerance, beyond).nearest();
}

namespace {

/// Returns the negative of the Newton step that minimises |y - x|^2/2 over the local coordinates s, t of x and of y.
Eigen::Vector4d newton_step(const Jet& x, const Jet& y) {
  const Vec3 r = y.x - x.x;
  const Eigen::Vector4d gradient(-r.dot(x.s), -r.dot(x.t), r.dot(y.s), r.dot(y.t));
  Eigen::Matrix4d h;
  h(0, 0) = x.s.dot(x.s) - r.dot(x.ss), h(0, 1) = x.s.dot(x.t) - r.dot(x.st), h(1, 1) = x.t.dot(x.t) - r.dot(x.tt);
  h(2, 2) = y.s.dot(y.s) + r.dot(y.ss), h(2, 3) = y.s.dot(y.t) + r.dot(y.st), h(3, 3) = y.t.dot(y.t) + r.dot(y.tt);
  h(0, 2) = -x.s.dot(y.s), h(0, 3) = -x.s.dot(y.t), h(1, 2) = -x.t.dot(y.s), h(1, 3) = -x.t.dot(y.t);
  return h.selfadjointView<Eigen::Upper>().ldlt().solve(gradient);
}

}  // namespace

double gap_to_wall(const BezierMap& map, const Net& net, const std::vector<int>& elements, const ElementBoxes& wall, double period, double tolerance,
                   double beyond) {
  double nearest = beyond;
  const int images = period > 0 ? 1 : 0;
  for (int image = -images; image <= images; ++image) {
    const Patches seen(map, net.rowwise() + image * period * Vec3::UnitX().transpose());
    nearest = std::min(nearest, closest_points(ElementBoxes(seen, elements), wall, tolerance, beyond).gap);
  }
  return nearest;
}

ClosestPoints nearest_points(const Patch& first, const Patch& second, const ClosestPoints& near) {
  const auto jets = [&](const Eigen::Vector4d& u) { return std::pair(jet(first, u[0], u[1]), jet(second, u[2], u[3])); };
  const auto points = [&](const Eigen::Vector4d& u) -> ClosestPoints {
    const Vec3 x = position(first, u[0], u[1]), y = position(second, u[2], u[3]);
    return {x, y, (y - x).norm(), {spline::Site{near.sites[0].element, u[0], u[1]}, spline::Site{near.sites[1].element, u[2], u[3]}}};
  };
  const Eigen::Vector4d start(near.sites[0].s, near.sites[0].t, near.sites[1].s, near.sites[1].t);
  const ClosestPoints before = points(start);
  Eigen::Vector4d u = start;
  double step_length = 1;
  for (int k = 0; k < 20 && step_length > 1e-12; ++k) {
    const auto [x, y] = jets(u);
    const Eigen::Vector4d step = newton_step(x, y);
    step_length = step.norm();
    u -= step;
    if (!((u.array() - 0.5).abs().maxCoeff() <= 0.6)) return before;
  }
  const ClosestPoints found = points(u);
  return step_length < 1e-7 && found.gap <= before.gap ? found : before;
}

namespace {

/// A grid of n x n sample points of an element with their normals, and the bounding box of the Bezier points of the element.
struct Sampled {
  std::vector<Vec3> place, normal;
  Eigen::AlignedBox3d box;

  Sampled(const Patch& patch, int n) {
    for (int k = 0; k < n * n; ++k) {
      const Jet at = jet(patch, k % n / (n - 1.), k / n / (n - 1.));
      place.push_back(at.x);
      normal.push_back(at.s.cross(at.t).normalized());
    }
    for (int b = 0; b < patch.n_bezier(); ++b) box.extend(Vec3(patch.coordinate(0, b), patch.coordinate(1, b), patch.coordinate(2, b)));
  }
};

std::vector<Sampled> sampled(const Patches& surface, int n) {
  std::vector<Sampled> all;
  for (int e = 0; e < surface.size(); ++e) all.emplace_back(surface[e], n);
  return all;
}

double distance(const Vec3& x, const Sampled& element) {
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < element.place.size(); ++k)
    if (const double squared = (element.place[k] - x).squaredNorm(); squared < least) least = squared, nearest = k;
  // `across`: distance of x from the tangent plane at the nearest sample point. `along`: distance of the foot of the perpendicular on this plane from
  // the sample point. If `along` is large, the foot may be beyond the element's edges, and another element is nearer than this plane. If x is far
  // behind the plane, it is in front of the other side of a thin body. In both cases, returns the distance from the sample point.
  const double across = (x - element.place[nearest]).dot(element.normal[nearest]), along = std::sqrt(std::max(0., least - across * across));
  return along > element.box.diagonal().norm() / 4 || across < -along ? std::sqrt(least) : std::max(across, 0.);
}

}  // namespace

std::vector<double> film_widths(const Patches& surface, std::span<const Patches* const> others, double reach) {
  const std::vector<Sampled> own = sampled(surface, 3);
  Eigen::AlignedBox3d around;
  for (const Sampled& element : own) around.extend(element.box);
  std::vector<double> widths(own.size(), std::numeric_limits<double>::infinity());
  for (const Patches* other : others)
    for (const Sampled& across : sampled(*other, 5)) {
      if (around.exteriorDistance(across.box) > reach) continue;
      for (std::size_t e = 0; e < own.size(); ++e) {
        if (own[e].box.exteriorDistance(across.box) > std::min(reach, widths[e])) continue;
        for (const Vec3& x : own[e].place)
          if (const double width = distance(x, across); width <= reach) widths[e] = std::min(widths[e], width);
      }
    }
  return widths;
}

}  // namespace tanktread::surface
