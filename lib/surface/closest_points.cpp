#include "surface/closest_points.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

namespace tanktread::surface {

namespace {

using Box = ElementBoxes::Box;
using Points = Eigen::Matrix3Xd;

void widen(Box& box, const Box& by) {
  box.low = box.low.min(by.low);
  box.high = box.high.max(by.high);
}

Points bezier_points(const Patch& patch) {
  return Eigen::Map<const Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::RowMajor>>(patch.points, 3, patch.n_bezier());
}

/// A part of an element: its Bezier points, s fastest.
struct Part {
  int degree;
  Points points;

  double size() const { return (corner(1, 1) - corner(0, 0)).cwiseAbs().maxCoeff() + (corner(1, 0) - corner(0, 1)).cwiseAbs().maxCoeff(); }
  Vec3 corner(int i, int j) const { return points.col(degree * (i + (degree + 1) * j)); }
  Vec3 middle() const { return points.rowwise().mean(); }
};

/// The two halves of a part along its longer side, by de Casteljau's rule.
std::pair<Part, Part> halves(const Part& part) {
  const int p = part.degree, n = p + 1;
  const bool along_s = (part.corner(1, 0) - part.corner(0, 0)).squaredNorm() + (part.corner(1, 1) - part.corner(0, 1)).squaredNorm() >
                       (part.corner(0, 1) - part.corner(0, 0)).squaredNorm() + (part.corner(1, 1) - part.corner(1, 0)).squaredNorm();
  const int step = along_s ? 1 : n, across = along_s ? n : 1;
  std::pair<Part, Part> result{part, part};
  Points& left = result.first.points;
  Points& right = result.second.points;  // in place: after k rounds its first p - k + 1 points of a row are those of the rule
  for (int row = 0; row < n; ++row)
    for (int k = 1; k <= p; ++k) {
      for (int i = 0; i <= p - k; ++i)
        right.col(row * across + i * step) = 0.5 * (right.col(row * across + i * step) + right.col(row * across + (i + 1) * step));
      left.col(row * across + k * step) = right.col(row * across);
    }
  return result;
}

/// By how much two sets lie apart in a direction from the first to the second, which is of length 1.
double separation(const Points& a, const Points& b, const Vec3& direction) {
  return (direction.transpose() * b).minCoeff() - (direction.transpose() * a).maxCoeff();
}

/// A part's normal at its middle, about.
Vec3 normal(const Part& part) {
  const Vec3 u = part.corner(1, 1) - part.corner(0, 0), v = part.corner(0, 1) - part.corner(1, 0);
  return u.cross(v).normalized();
}

class Search {
 public:
  Search(const ElementBoxes& first, const ElementBoxes& second, double tolerance, double beyond) : trees_{&first, &second}, tolerance_(tolerance) {
    best_.gap = beyond;
  }

  ClosestPoints nearest() {
    push({distance(trees_[0]->boxes()[0], trees_[1]->boxes()[0]), {0, 0}, {-1, -1}});
    while (!queue_.empty() && queue_.top().bound < best_.gap - tolerance_) {
      const Pair pair = queue_.top();
      queue_.pop();
      if (pair.part[0] < 0)
        open_boxes(pair);
      else
        open_parts(pair);
    }
    return best_;
  }

 private:
  /// Two boxes, or where these hold an element each, two parts of those.
  struct Pair {
    double bound;
    int box[2], part[2];
    bool operator<(const Pair& other) const { return bound > other.bound; }  // the first of a queue is the nearest
  };

  void push(const Pair& pair) {
    if (pair.bound < best_.gap - tolerance_) queue_.push(pair);
  }

  const Box& box(const Pair& pair, int k) const { return trees_[k]->boxes()[static_cast<std::size_t>(pair.box[k])]; }
  bool single(const Pair& pair, int k) const { return box(pair, k).last - box(pair, k).first == 1; }

  void open_boxes(const Pair& pair) {
    if (single(pair, 0) && single(pair, 1)) {
      Pair parts = pair;
      for (int k = 0; k < 2; ++k) parts.part[k] = whole(k, trees_[k]->element(box(pair, k).first));
      parts.bound = bound(parts);
      return push(parts);
    }
    const auto extent = [&](int k) { return single(pair, k) ? -1 : (box(pair, k).high - box(pair, k).low).maxCoeff(); };
    const int opened = extent(0) > extent(1) ? 0 : 1;
    for (const int child : box(pair, opened).child) {
      Pair next = pair;
      next.box[opened] = child;
      next.bound = distance(box(next, 0), box(next, 1));
      push(next);
    }
  }

  void open_parts(const Pair& pair) {
    const int opened = part(0, pair).size() > part(1, pair).size() ? 0 : 1;
    for (const int child : children(opened, pair.part[opened])) {
      Pair next = pair;
      next.part[opened] = child;
      meet(part(0, next), part(1, next));
      next.bound = std::max(pair.bound, bound(next));
      push(next);
    }
  }

  /// Corners are points of the surface.
  void meet(const Part& a, const Part& b) {
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        const Vec3 x = a.corner(i % 2, i / 2), y = b.corner(j % 2, j / 2);
        if (const double gap = (y - x).norm(); gap < best_.gap) best_ = {x, y, gap};
      }
  }

  double bound(const Pair& pair) const {
    const Part &a = part(0, pair), &b = part(1, pair);
    const Vec3 between = b.middle() - a.middle();
    double most = 0;
    for (Vec3 direction : {between, normal(a), normal(b), Vec3(best_.second - best_.first)}) {
      const double length = direction.norm();
      if (!(length > 0)) continue;
      direction *= (direction.dot(between) < 0 ? -1 : 1) / length;
      most = std::max(most, separation(a.points, b.points, direction));
    }
    return most;
  }

  int whole(int k, int element) {
    const auto found = std::ranges::find(elements_[k], element, &std::pair<int, int>::first);
    if (found != elements_[k].end()) return found->second;
    const Patch& patch = trees_[k]->surface()[element];
    elements_[k].emplace_back(element, add(k, {patch.degree, bezier_points(patch)}));
    return elements_[k].back().second;
  }

  int add(int k, Part part) {
    parts_[k].push_back(std::move(part));
    children_[k].push_back(-1);
    return static_cast<int>(parts_[k].size()) - 1;
  }

  std::array<int, 2> children(int k, int number) {
    int& first = children_[k][static_cast<std::size_t>(number)];
    if (first < 0) {
      auto [left, right] = halves(parts_[k][static_cast<std::size_t>(number)]);
      const int added = add(k, std::move(left));
      add(k, std::move(right));
      children_[k][static_cast<std::size_t>(number)] = added;
      return {added, added + 1};
    }
    return {first, first + 1};
  }

  const Part& part(int k, const Pair& pair) const { return parts_[k][static_cast<std::size_t>(pair.part[k])]; }

  const ElementBoxes* trees_[2];
  double tolerance_;
  std::priority_queue<Pair> queue_;
  std::vector<Part> parts_[2];
  std::vector<int> children_[2];                    // the first of the two of each part
  std::vector<std::pair<int, int>> elements_[2];    // that are parts by now, and which
  ClosestPoints best_{Vec3::Zero(), Vec3::Zero(), 0};
};

}  // namespace

ElementBoxes::ElementBoxes(const Patches& surface) : surface_(surface), order_(static_cast<std::size_t>(surface.size())) {
  std::iota(order_.begin(), order_.end(), 0);
  for (int e = 0; e < surface.size(); ++e) {
    const Points points = bezier_points(surface[e]);
    own_.push_back({points.rowwise().minCoeff(), points.rowwise().maxCoeff(), 0, 0});
  }
  split(0, surface.size());
}

int ElementBoxes::split(int first, int last) {
  Box box{Eigen::Array3d::Constant(std::numeric_limits<double>::infinity()), Eigen::Array3d::Constant(-std::numeric_limits<double>::infinity()),
          first, last};
  for (int k = first; k < last; ++k) widen(box, own_[static_cast<std::size_t>(order_[static_cast<std::size_t>(k)])]);
  const int number = static_cast<int>(boxes_.size());
  boxes_.push_back(box);
  if (last - first == 1) return number;
  int longest;
  (box.high - box.low).maxCoeff(&longest);
  const int middle = first + (last - first) / 2;
  const auto centre = [&](int e) { return own_[static_cast<std::size_t>(e)].low[longest] + own_[static_cast<std::size_t>(e)].high[longest]; };
  std::nth_element(order_.begin() + first, order_.begin() + middle, order_.begin() + last, [&](int a, int b) { return centre(a) < centre(b); });
  const int left = split(first, middle), right = split(middle, last);
  boxes_[static_cast<std::size_t>(number)].child[0] = left;
  boxes_[static_cast<std::size_t>(number)].child[1] = right;
  return number;
}

double distance(const Box& a, const Box& b) { return (b.low - a.high).max(a.low - b.high).max(0.).matrix().norm(); }

ClosestPoints closest_points(const ElementBoxes& first, const ElementBoxes& second, double tolerance, double beyond) {
  return Search(first, second, tolerance, beyond).nearest();
}

}  // namespace tanktread::surface
