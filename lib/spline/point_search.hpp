#pragma once
// Search for points in space by position.

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "base/types.hpp"

namespace tanktread::spline {

/// Points in space, sorted along one direction, in which a point is found by its position.
class PointSearch {
 public:
  PointSearch(std::vector<Vec3> points, double tolerance) : points_(std::move(points)), tolerance_(tolerance) {
    for (std::size_t i = 0; i < points_.size(); ++i) order_.emplace_back(along(points_[i]), static_cast<int>(i));
    std::ranges::sort(order_);
  }

  const std::vector<Vec3>& all() const { return points_; }

  /// Returns the index of the first point (in ascending order of the coordinate `along`) within the tolerance of x, or -1 if there is none.
  int at(const Vec3& x) const {
    const double from = along(x) - 2 * tolerance_;
    for (auto i = std::ranges::lower_bound(order_, std::pair(from, 0)); i != order_.end() && i->first <= from + 4 * tolerance_; ++i)
      if ((points_[i->second] - x).norm() <= tolerance_) return i->second;
    return -1;
  }

  /// Returns the index of the point nearest to x, or -1 if no point is closer than `within`.
  int nearest(const Vec3& x, double within) const {
    const double from = along(x);
    int found = -1;
    for (auto after = std::ranges::lower_bound(order_, std::pair(from, 0)), before = after; after != order_.end() || before != order_.begin();) {
      const bool ahead = before == order_.begin() || (after != order_.end() && after->first - from <= from - std::prev(before)->first);
      const auto& [coordinate, i] = ahead ? *after++ : *--before;
      if (std::abs(coordinate - from) > within) break;  // the distance to all other points is larger
      if (const double off = (points_[i] - x).norm(); off < within) found = i, within = off;
    }
    return found;
  }

 private:
  static double along(const Vec3& x) { return x.dot(Vec3(0.61, 0.53, 0.59)); }  // coordinate along a direction with which no mesh is aligned

  std::vector<Vec3> points_;
  double tolerance_;
  std::vector<std::pair<double, int>> order_;
};

}  // namespace tanktread::spline
