#include "surface/silhouette.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include "base/errors.hpp"
#include "base/indices.hpp"
#include "surface/patch.hpp"

namespace tanktread::surface {
namespace {

constexpr int samples = 10000;  // sampled points of the surface, at least
constexpr int finer = 6;        // points of a fold per triangle of samples; chords are then about 1/300 of the size, and lie 1e-6 of it off the arc
constexpr double inside = 1e-3;  // the normal is evaluated this far inside its element, because it is not defined at a pole
constexpr double same = 1e-7;    // sampled points of neighbouring elements whose distance is a smaller fraction of the size are one vertex
constexpr double tilt = 1e-6;    // slope by which the direction is turned, so that no part of the surface is seen exactly along it
constexpr double slit = 2e-4;    // narrowest slit in an outline, as a fraction of the size

using Vec2 = Eigen::Vector2d;

double cross(const Vec2& a, const Vec2& b) { return a[0] * b[1] - a[1] * b[0]; }

/// The folds of the projection: images of the curves on which the normal is perpendicular to the view. A segment joins two nodes.
struct Folds {
  std::vector<Vec3> nodes;  ///< two coordinates in the image, and the distance along the view
  std::vector<std::array<int, 2>> segments;
};

/// A sampled point: position (in the image and along the view), normal component along the view, element and local coordinates.
struct Sample {
  Vec3 x;
  double value;
  Vec2 at;
};

/// Returns for each sample the number of its vertex. Samples of neighbouring elements at their common side are one vertex.
std::vector<int> vertices(const std::vector<Sample>& all, double distance) {
  const Vec3 along(0.53, 0.61, 0.59);  // in general position, so that few samples have nearly the same component along it
  std::vector<int> order = indices(all.size()), vertex = order;
  std::ranges::sort(order, {}, [&](int k) { return along.dot(all[k].x); });
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i; j-- > 0 && along.dot(all[order[i]].x - all[order[j]].x) < distance;)
      if ((all[order[i]].x - all[order[j]].x).norm() < distance) {
        vertex[order[i]] = vertex[order[j]];
        break;
      }
  return vertex;
}

/// Closes the curves by segments between open ends that are nearest to each other, where a side of an element is that of two smaller elements.
void close_ends(Folds& folds) {
  std::vector<int> degree(folds.nodes.size());
  for (const auto& segment : folds.segments)
    for (const int k : segment) ++degree[k];
  std::vector<int> ends;
  for (int k = 0; k < static_cast<int>(degree.size()); ++k)
    if (degree[k] % 2 == 1) ends.push_back(k);
  while (ends.size() > 1) {
    std::pair<std::size_t, std::size_t> best{0, 1};
    const auto distance = [&](std::size_t i, std::size_t j) { return (folds.nodes[ends[i]] - folds.nodes[ends[j]]).squaredNorm(); };
    for (std::size_t i = 0; i < ends.size(); ++i)
      for (std::size_t j = i + 1; j < ends.size(); ++j)
        if (distance(i, j) < distance(best.first, best.second)) best = {i, j};
    folds.segments.push_back({ends[best.first], ends[best.second]});
    ends.erase(ends.begin() + static_cast<long>(best.second)), ends.erase(ends.begin() + static_cast<long>(best.first));
  }
}

/// Returns the folds of the surface. They cross triangles of samples where the normal component along the view changes sign. This component is
/// interpolated linearly. An error d of the position of a fold moves its image by d^2 only, because the nodes are on the exact surface.
Folds folds_of(const Patches& surface, const Mat3& frame) {
  const int k = std::max(4, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(samples) / surface.size()))));
  std::vector<Sample> all;
  for (int e = 0; e < surface.size(); ++e)
    for (int n = 0; n < (k + 1) * (k + 1); ++n) {
      const Vec2 at(static_cast<double>(n % (k + 1)) / k, static_cast<double>(n / (k + 1)) / k);
      const Jet near = jet(surface[e], std::clamp(at[0], inside, 1 - inside), std::clamp(at[1], inside, 1 - inside));
      all.push_back({frame * position(surface[e], at[0], at[1]), frame.row(2).dot(near.s.cross(near.t).normalized()), at});
    }
  Vec3 low = all[0].x, high = low;
  for (const Sample& one : all) low = low.cwiseMin(one.x), high = high.cwiseMax(one.x);
  if (!((high - low).norm() < std::numeric_limits<double>::infinity())) throw RunFailure("the surface contains NaN, and has no outline");
  const std::vector<int> vertex = vertices(all, same * (high - low).maxCoeff());
  std::vector<double> value(all.size());
  for (std::size_t n = 0; n < all.size(); ++n) value[vertex[n]] += all[n].value;

  Folds folds;
  std::map<std::pair<int, int>, int> known;  // node on each side of a triangle that a fold crosses
  const auto crossed = [&](int e, const std::array<int, 3>& corners) {
    const auto above = [&](int j) { return value[vertex[corners[j % 3]]] > 0; };
    for (int odd = 0; odd < 3; ++odd) {  // the corner with another sign than both others
      if (above(odd) == above(odd + 1) || above(odd) == above(odd + 2)) continue;
      std::array<Vec2, 2> at;
      std::array<int, 2> node;
      for (int side = 0; side < 2; ++side) {
        const int a = corners[odd], b = corners[(odd + 1 + side) % 3];
        const double here = value[vertex[a]], there = value[vertex[b]];
        at[side] = all[a].at + here / (here - there) * (all[b].at - all[a].at);
        const auto [found, fresh] = known.try_emplace(std::minmax(vertex[a], vertex[b]), static_cast<int>(folds.nodes.size()));
        if (fresh) folds.nodes.push_back(frame * position(surface[e], at[side][0], at[side][1]));
        node[side] = found->second;
      }
      for (int part = 1, before = node[0]; part <= finer; ++part) {
        const Vec2 here = at[0] + static_cast<double>(part) / finer * (at[1] - at[0]);
        const int next = part == finer ? node[1] : static_cast<int>(folds.nodes.size());
        if (part < finer) folds.nodes.push_back(frame * position(surface[e], here[0], here[1]));
        folds.segments.push_back({std::exchange(before, next), next});
      }
    }
  };
  for (int e = 0; e < surface.size(); ++e)
    for (int n = 0; n < k * k; ++n) {
      const int a = e * (k + 1) * (k + 1) + n / k * (k + 1) + n % k, d = a + k + 1;
      crossed(e, {a, a + 1, d + 1}), crossed(e, {a, d + 1, d});
    }
  close_ends(folds);
  return folds;
}

/// An edge from a point of the graph of the folds to another, and its direction.
struct Edge {
  int to;
  double angle;
};

/// Returns the outer boundary of the folds, counter-clockwise: divides the segments where they cross, and walks from the rightmost point so that no
/// edge lies to the right.
std::vector<Vec2> envelope(const Folds& folds) {
  std::vector<Vec2> points;
  for (const Vec3& node : folds.nodes) points.push_back(node.head<2>());
  struct Segment {
    std::array<int, 2> ends;
    double left, right;
    std::vector<std::pair<double, int>> along;  // points on the segment, with their positions from 0 to 1
  };
  std::vector<Segment> all;
  for (const auto& [a, b] : folds.segments)
    all.push_back({{a, b}, std::min(points[a][0], points[b][0]), std::max(points[a][0], points[b][0]), {{0, a}, {1, b}}});
  std::ranges::sort(all, {}, &Segment::left);
  const auto share_end = [](const Segment& i, const Segment& j) {
    return i.ends[0] == j.ends[0] || i.ends[0] == j.ends[1] || i.ends[1] == j.ends[0] || i.ends[1] == j.ends[1];
  };
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = i + 1; j < all.size() && all[j].left <= all[i].right; ++j) {
      if (share_end(all[i], all[j])) continue;
      const Vec2 from = points[all[i].ends[0]], step = points[all[i].ends[1]] - from;
      const Vec2 other = points[all[j].ends[1]] - points[all[j].ends[0]], off = points[all[j].ends[0]] - from;
      const double area = cross(step, other), on_i = cross(off, other) / area, on_j = cross(off, step) / area;
      if (!(on_i >= 0 && on_i <= 1 && on_j >= 0 && on_j <= 1)) continue;
      const int made = static_cast<int>(points.size());
      points.push_back(from + on_i * step);
      all[i].along.emplace_back(on_i, made), all[j].along.emplace_back(on_j, made);
    }
  std::vector<std::vector<Edge>> edges(points.size());
  for (Segment& one : all) {
    std::ranges::sort(one.along);
    const Vec2 step = points[one.ends[1]] - points[one.ends[0]];
    for (std::size_t k = 1; k < one.along.size(); ++k) {
      const int a = one.along[k - 1].second, b = one.along[k].second;
      edges[a].push_back({b, std::atan2(step[1], step[0])}), edges[b].push_back({a, std::atan2(-step[1], -step[0])});
    }
  }
  const int start = static_cast<int>(std::ranges::max_element(points, {}, [](const Vec2& x) { return x[0]; }) - points.begin());
  std::vector<Vec2> outline;
  double back = 0;  // direction from which the walk arrives; outside, at first
  const Edge* first = nullptr;
  for (int at = start; outline.size() <= 2 * points.size();) {
    const auto turn = [&](const Edge& edge) {  // counter-clockwise from `back`, and last the edge by which the walk arrives
      const double angle = std::remainder(edge.angle - back, 2 * std::numbers::pi);
      return angle > 1e-12 ? angle : angle + 2 * std::numbers::pi;  // directions of one segment differ by round-off
    };
    const Edge& next = *std::ranges::min_element(edges[at], {}, turn);
    if (&next == first) return outline;
    if (!first) first = &next;
    outline.push_back(points[at]);
    at = next.to, back = next.angle + std::numbers::pi;
  }
  throw RunFailure("the outline of the surface is not closed: the surface has no folds in the direction of Output/view direction");
}

/// Returns the polygon without slits that are narrower than `width`, which arise where two arcs nearly coincide. Removes the tip of a slit, where the
/// polygon turns back by more than 143 degrees, until its sides are `width` apart.
std::vector<Vec2> without_slits(const std::vector<Vec2>& polygon, double width) {
  std::vector<Vec2> kept;
  const auto turns_back = [&](const Vec2& next) {
    const Vec2 a = kept.back() - kept[kept.size() - 2], b = next - kept.back();
    return a.dot(b) <= -0.8 * a.norm() * b.norm() && std::abs(cross(a, b)) <= width * std::max(a.norm(), b.norm());
  };
  for (std::size_t k = 0; k <= polygon.size(); ++k) {
    const Vec2& next = polygon[k % polygon.size()];
    while (kept.size() > 1 && turns_back(next)) kept.pop_back();
    kept.push_back(next);
  }
  kept.pop_back();
  return kept;
}

/// Returns the area of a polygon and its circularity.
std::array<double, 2> size_of(const std::vector<Vec2>& polygon) {
  double area = 0, perimeter = 0;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec2 a = polygon[k] - polygon[0], b = polygon[(k + 1) % polygon.size()] - polygon[0];
    area += cross(a, b) / 2, perimeter += (b - a).norm();
  }
  return {area, 4 * std::numbers::pi * area / (perimeter * perimeter)};
}

/// Returns the convex hull of points, counter-clockwise, by Andrew's monotone chain.
std::vector<Vec2> hull(std::vector<Vec2> points) {
  std::ranges::sort(points, {}, [](const Vec2& x) { return std::pair(x[0], x[1]); });
  std::vector<Vec2> chain;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t begin = chain.size();
    for (const Vec2& x : points) {
      while (chain.size() >= begin + 2 && cross(chain.back() - chain[chain.size() - 2], x - chain.back()) <= 0) chain.pop_back();
      chain.push_back(x);
    }
    chain.pop_back();
    std::ranges::reverse(points);
  }
  return chain;
}

}  // namespace

Silhouette silhouette(const BezierMap& map, const Net& x, const Vec3& view) {
  const Vec3 along = view.normalized(), u = along.unitOrthogonal(), v = along.cross(u), turned = (along + tilt * (0.6 * u + 0.8 * v)).normalized();
  const Vec3 right = (u - u.dot(turned) * turned).normalized();
  Mat3 frame;
  frame << right.transpose(), turned.cross(right).transpose(), turned.transpose();
  const Vec3 middle = x.colwise().mean().transpose();
  const std::vector<Vec2> rough = envelope(folds_of(Patches(map, x.rowwise() - middle.transpose()), frame));
  Eigen::AlignedBox2d box;
  for (const Vec2& point : rough) box.extend(point);
  const std::vector<Vec2> outline = without_slits(rough, slit * box.sizes().maxCoeff());
  const auto [area, circularity] = size_of(outline);
  const auto [hull_area, hull_circularity] = size_of(hull(outline));
  return {area, circularity, hull_area, hull_circularity};
}

}  // namespace tanktread::surface
