#include "stokes/flow/outline_space.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "spline/bernstein.hpp"

namespace tanktread::stokes {
namespace {

using surface::CubicCurve;
using surface::Outline;
using surface::PlaneCurve;
using Crowding = OutlineSpace::Crowding;

constexpr double right_angle = std::numbers::pi / 2;

/// A corner of angle a makes the density behave like s^(pi/a - 1), and s log s at a right angle.
double exponent(double angle) { return angle < 1.05 * right_angle ? 2 : 3; }

double crowded(const Crowding& c, double t) {
  const double a = std::pow(t, c.first), b = std::pow(1 - t, c.last);
  return a / (a + b);
}

double crowded_slope(const Crowding& c, double t) {
  const double a = std::pow(t, c.first), b = std::pow(1 - t, c.last);
  return std::pow(t, c.first - 1) * std::pow(1 - t, c.last - 1) * (c.first * (1 - t) + c.last * t) / ((a + b) * (a + b));
}

/// By bisection: w rises.
double uncrowded(const Crowding& c, double w) {
  double low = 0, high = 1;
  for (int k = 0; k < 60; ++k) (crowded(c, (low + high) / 2) < w ? low : high) = (low + high) / 2;
  return (low + high) / 2;
}

/// Knots of the outline's own curve, in t.
std::vector<double> own_knots(const PlaneCurve& side, const Crowding& crowding) {
  const auto [first, last] = surface::range(side);
  const bool open = !surface::closed(side);
  std::vector<double> out = open ? std::vector<double>{0, 1} : std::vector<double>{first, last};
  const auto* cubic = std::get_if<CubicCurve>(&side);
  if (!cubic) return out;
  for (std::size_t i = 1; i + 1 < cubic->breaks.size(); ++i) {
    const double u = cubic->breaks[i];
    out.insert(out.end() - 1, open ? uncrowded(crowding, (u - first) / (last - first)) : u);
  }
  return out;
}

/// Elements of each side, two or more, by the square root of its length: what is short is near a corner everywhere.
std::vector<int> shares(const Outline& outline, int elements) {
  if (outline.smooth()) return {elements};
  double total = 0;
  for (int k = 0; k < outline.n_sides(); ++k) total += std::sqrt(outline.side_length(k));
  std::vector<int> out;
  for (int k = 0; k < outline.n_sides(); ++k)
    out.push_back(std::max(2, static_cast<int>(std::ceil(elements * std::sqrt(outline.side_length(k)) / total - 1e-9))));
  return out;
}

/// Every interval cut evenly into pieces of about (last - first)/elements, no longer than 1.25 times as much.
std::vector<double> divided(const std::vector<double>& knots, int elements) {
  const double most = 1.25 * (knots.back() - knots.front()) / elements;
  std::vector<double> out;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const int pieces = knots.size() == 2 ? elements : static_cast<int>(std::ceil((knots[i + 1] - knots[i]) / most));
    for (int j = 0; j < pieces; ++j) out.push_back(knots[i] + (knots[i + 1] - knots[i]) * j / pieces);
  }
  out.push_back(knots.back());
  return out;
}

}  // namespace

OutlineSpace::OutlineSpace(const Outline& outline, int elements) : outline_(outline) {
  const auto share = shares(outline, elements);
  for (int k = 0; k < outline.n_sides(); ++k) {
    crowding_.push_back({exponent(outline.corner_angle(k)), exponent(outline.corner_angle((k + 1) % outline.n_sides()))});
    const auto knots = divided(own_knots(outline.side(k), crowding_.back()), share[static_cast<std::size_t>(k)]);
    surface::closed(outline.side(k)) ? add_closed(k, knots) : add_open(k, knots);
  }
}

/// `knots`: the eight around the element, the element between the fourth and the fifth.
void OutlineSpace::add_element(int side, double begin, double end, const std::array<int, 4>& functions,
                               const std::array<double, 8>& knots) {
  OutlineElement element{side, begin, end, functions, {}};
  for (std::size_t a = 0; a < 4; ++a) {
    const auto b = spline::b_spline_on({knots[a], knots[a + 1], knots[a + 2], knots[a + 3], knots[a + 4]}, begin, end);
    for (std::size_t i = 0; i < 4; ++i) element.bernstein(static_cast<int>(a), static_cast<int>(i)) = b[i];
  }
  elements_.push_back(element);
}

void OutlineSpace::add_closed(int side, const std::vector<double>& knots) {
  const int m = static_cast<int>(knots.size()) - 1, first = size();
  const double period = knots.back() - knots.front();
  const auto knot = [&](int i) {
    const int turn = i < 0 ? -1 : i >= m ? 1 : 0;
    return knots[static_cast<std::size_t>(i - turn * m)] + turn * period;
  };
  for (int e = 0; e < m; ++e) {
    std::array<int, 4> functions;
    std::array<double, 8> around;
    for (int a = 0; a < 4; ++a) functions[static_cast<std::size_t>(a)] = first + (e - 1 + a + m) % m;
    for (int i = 0; i < 8; ++i) around[static_cast<std::size_t>(i)] = knot(e - 3 + i);
    sites_.push_back({side, knot(e), static_cast<int>(elements_.size())});
    add_element(side, knot(e), knot(e + 1), functions, around);
  }
}

void OutlineSpace::add_open(int side, const std::vector<double>& knots) {
  const int m = static_cast<int>(knots.size()) - 1, first = size(), first_element = static_cast<int>(elements_.size());
  const auto knot = [&](int i) { return knots[static_cast<std::size_t>(std::clamp(i, 0, m))]; };
  for (int e = 0; e < m; ++e) {
    std::array<double, 8> around;
    for (int i = 0; i < 8; ++i) around[static_cast<std::size_t>(i)] = knot(e - 3 + i);
    add_element(side, knot(e), knot(e + 1), {first + e, first + e + 1, first + e + 2, first + e + 3}, around);
  }
  std::vector<double> greville;
  for (int i = -1; i < m + 2; ++i) greville.push_back((knot(i - 1) + knot(i) + knot(i + 1)) / 3);
  greville.front() = (greville[0] + greville[1]) / 2;
  greville.back() = (greville[greville.size() - 1] + greville[greville.size() - 2]) / 2;
  for (const double t : greville) {
    const auto after = std::upper_bound(knots.begin() + 1, knots.end() - 1, t);
    sites_.push_back({side, t, first_element + static_cast<int>(after - knots.begin()) - 1});
  }
}

surface::PlaneJet OutlineSpace::at(int side, double t) const {
  if (surface::closed(outline_.side(side))) return outline_.at(side, t);
  const auto [first, last] = surface::range(outline_.side(side));
  const Crowding& c = crowding_[static_cast<std::size_t>(side)];
  surface::PlaneJet j = outline_.at(side, first + (last - first) * crowded(c, t));
  j.d *= (last - first) * crowded_slope(c, t);
  return j;
}

}  // namespace tanktread::stokes
