#pragma once
// Outlines that several tests use.

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "surface/walls/outline.hpp"

namespace tanktread {

inline surface::Outline ellipse(double a, double b) { return surface::Outline({surface::Ellipse{surface::Vec2::Zero(), surface::Vec2(a, b)}}); }

/// Returns a polygon with these corners, counter-clockwise.
inline surface::Outline polygon(const std::vector<surface::Vec2>& corners) {
  std::vector<surface::PlaneCurve> sides;
  for (std::size_t k = 0; k < corners.size(); ++k)
    sides.push_back(surface::interpolate_open({0, 1}, {corners[k], corners[(k + 1) % corners.size()]}));
  return surface::Outline(std::move(sides));
}

/// Returns a trefoil, r = 1 + 0.3 cos 3t, as a spline through n points.
inline surface::Outline trefoil(int n) {
  std::vector<double> breaks;
  std::vector<surface::Vec2> points;
  for (int i = 0; i <= n; ++i) {
    const double t = 2 * std::numbers::pi * i / n;
    breaks.push_back(t);
    if (i < n) points.push_back((1 + 0.3 * std::cos(3 * t)) * surface::Vec2(std::cos(t), std::sin(t)));
  }
  return surface::Outline({surface::interpolate_closed(breaks, points)});
}

}  // namespace tanktread
