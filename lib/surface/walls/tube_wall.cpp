#include "surface/walls/tube_wall.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "surface/spline_lines.hpp"

namespace tanktread::surface {
namespace {

/// Returns the number of elements between 0 and x, up to a constant factor: int_0^x (1 + (g - 1)/(1 + y^4)) dy with g = `grading`. x is a position
/// along the wall, divided by the length w (see tube_wall()).
double count(double x, double grading) {
  const double r = std::numbers::sqrt2;
  const double bell =
      std::log((x * x + r * x + 1) / (x * x - r * x + 1)) / (4 * r) + (std::atan(r * x + 1) + std::atan(r * x - 1)) / (2 * r);
  return x + (grading - 1) * bell;
}

std::vector<double> graded_knots(double length, int elements, double grading, double width) {
  const double total = count(length / (2 * width), grading);
  std::vector<double> knots;
  for (int k = 0; k <= elements; ++k) {
    const double wanted = total * (2. * k / elements - 1);
    double low = -length / (2 * width), high = -low;
    for (int step = 0; step < 60; ++step) (count((low + high) / 2, grading) < wanted ? low : high) = (low + high) / 2;
    knots.push_back(width * (low + high) / 2);
  }
  knots.front() = -length / 2, knots.back() = length / 2;
  return knots;
}

/// Sets up periodic splines for the densities on a wall. `knots`: knots of these splines, which divide the period into elements. The ends of the wall
/// lie inside the last of these elements and cut it in two.
void repeat(TubeWall& wall, const Line& around, const std::vector<double>& knots) {
  const RepeatingLine along = repeating(knots, {wall.start, wall.end});
  wall.sites = sites_of(along.open, around);
  const int elements = static_cast<int>(along.middles.size()), m = static_cast<int>(around.pieces.size());
  for (int piece = 0; piece <= elements; ++piece)
    for (int k = 0; k < m; ++k) {
      wall.middle_of.push_back(piece % elements * m + k);
      if (piece < elements) wall.middles.push_back({piece * m + k, along.middles[static_cast<std::size_t>(piece)], 0.5});
    }
  wall.open_from_periodic = kronecker(along.open_from_periodic, Eigen::MatrixXd::Identity(around.n, around.n));
  wall.period = wall.end - wall.start;
}

/// Returns a wall whose control net is allocated but not set, and the control points of the outline. `knots`: knots of the wall's surface along the
/// axis. `periodic`: knots of the periodic splines for densities, which lie between the first and the last of `knots`; empty if the wall is not
/// periodic.
std::pair<TubeWall, std::vector<Vec2>> woven(DuctKind kind, const Outline& section, const std::vector<double>& knots, int azimuthal_elements,
                                             const std::vector<double>& periodic) {
  Line along, around;
  add(along, knots, false, false);
  TubeWall wall{.kind = kind, .outline = section.spline(azimuthal_elements), .start = knots.front(), .end = knots.back()};
  std::vector<Vec2> ring;
  for (int k = 0; k < wall.outline.n_sides(); ++k) {
    const CubicCurve& side = std::get<CubicCurve>(wall.outline.side(k));
    const std::vector<Vec2> points = control_points(side);
    ring.insert(ring.end(), points.begin(), points.end());
    add(around, side.breaks, side.closed, !side.closed);
  }
  wall.space = product(along, around);
  wall.n_along = along.n, wall.n_around = around.n;
  wall.space.description = formatted("%d x %d cubic elements, %d control points", static_cast<int>(around.pieces.size()),
                                     static_cast<int>(along.pieces.size()), wall.space.n_points);
  wall.net.resize(wall.space.n_points, 3);
  if (!periodic.empty()) {
    repeat(wall, around, periodic);
  } else {
    wall.sites = wall.space.collocation;
    for (int e = 0; e < static_cast<int>(wall.space.elements.size()); ++e) wall.middles.push_back({e, 0.5, 0.5}), wall.middle_of.push_back(e);
  }
  return {std::move(wall), std::move(ring)};
}

TubeWall straight_wall(const Outline& section, int azimuthal_elements, const std::vector<double>& knots, const std::vector<double>& periodic) {
  auto [wall, ring] = woven(DuctKind::straight_tube, section, knots, azimuthal_elements, periodic);
  wall.space.description = "tube, " + wall.space.description;
  const int last = static_cast<int>(knots.size()) - 1;
  const auto knot = [&](int i) { return knots[static_cast<std::size_t>(std::clamp(i, 0, last))]; };
  for (int i = 0; i < wall.n_along; ++i) {
    // Greville abscissa of row i of the control points. With these values of x1, x1 is a linear function of the parameter along the wall.
    const double place = (knot(i - 2) + knot(i - 1) + knot(i)) / 3;
    for (int k = 0; k < wall.n_around; ++k)
      wall.net.row(i * wall.n_around + k) << place, ring[k][0], ring[k][1];
  }
  wall.widest = std::max(knot(last / 2 + 1) - knot(last / 2), wall.outline.length() / azimuthal_elements);
  return std::move(wall);
}

}  // namespace

TubeWall tube_wall(const Outline& section, const TubeOptions& options, double length, double half_length) {
  const double width = std::max(section.radius(), half_length);
  return straight_wall(section, options.azimuthal_elements, graded_knots(length, options.elements_along(), options.grading, width), {});
}

TubeWall periodic_tube_wall(const Outline& section, const TubeOptions& options, double period, int elements, double half_length) {
  const std::vector<double> twice = graded_knots(period, 2 * elements, options.grading, std::max(section.radius(), half_length));
  std::vector<double> knots;
  for (std::size_t k = 1; k < twice.size(); k += 2) knots.push_back(twice[k]);
  const double start = -period / 2 - (twice[1] - twice[0]) / 2;
  std::vector<double> ends{start};
  ends.insert(ends.end(), knots.begin(), knots.end());
  ends.push_back(start + period);
  return straight_wall(section, options.azimuthal_elements, ends, knots);
}

namespace {

/// Returns the control points of the spline along the channel that interpolates the quantity value(section) at the knots. Its slopes at the ends and
/// at triple knots are one-sided differences of the quantity.
std::vector<Vec2> through(const Channel& channel, const std::vector<double>& knots, const std::function<Vec2(const Channel::Section&)>& value) {
  const auto at = [&](double u) { return value(channel.at(u)); };
  const double step = 1e-6 * (knots.back() - knots.front());
  const auto slope = [&](double u, double h) -> Vec2 { return (4 * at(u + h) - 3 * at(u) - at(u + 2 * h)) / (2 * h); };
  std::vector<Vec2> all;
  for (auto first = knots.begin(); first + 1 < knots.end();) {
    const auto last = std::adjacent_find(first, knots.end()), end = last == knots.end() ? last : last + 1;
    const std::vector<double> part(first, end);
    std::vector<Vec2> points;
    for (const double u : part) points.push_back(at(u));
    const auto span = control_points(interpolate_open(part, points, slope(part.front(), step), slope(part.back(), -step)));
    all.insert(all.end(), span.begin() + !all.empty(), span.end());
    first = last == knots.end() ? last : last + 2;
  }
  return all;
}

}  // namespace

TubeWall channel_wall(std::shared_ptr<const Channel> channel, int azimuthal_elements) {
  std::vector<double> knots = channel->knots(channel->elements()), periodic;
  if (channel->repeats()) {  // moves both ends of the wall, relative to the knots of the periodic splines, to a quarter of an element after a knot
    periodic.assign(knots.begin(), knots.end() - 1);
    const double before = 0.75 * (knots.back() - periodic.back());
    knots.insert(knots.begin(), knots.front() - before);
    knots.back() -= before;
  }
  auto [wall, ring] = woven(DuctKind::channel, channel->outline(), knots, azimuthal_elements, periodic);
  wall.space.description = "channel, " + wall.space.description;
  // scales the spline approximation of the outline to the exact area
  const double wider = std::sqrt(channel->outline().area() / wall.outline.area());
  for (Vec2& point : ring) point *= wider;
  double narrowest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < knots.size(); ++k) {
    const Channel::Section at = channel->at(knots[k]);
    if (k == 0 || at.factor.minCoeff() > narrowest) continue;
    const double widest = std::max(knots[k] - knots[k - 1], wall.outline.length() * at.factor.minCoeff() / azimuthal_elements);
    // If several knots have the narrowest cross-section, uses the smallest `widest` of these knots, because elements at the ends of a straight
    // channel are longer.
    wall.widest = at.factor.minCoeff() < narrowest ? widest : std::min(wall.widest, widest);
    narrowest = at.factor.minCoeff();
  }
  const auto centre = through(*channel, knots, [](const Channel::Section& at) -> Vec2 { return at.centre.head<2>(); });
  const auto across = through(*channel, knots, [](const Channel::Section& at) -> Vec2 { return at.factor[0] * at.normal.head<2>(); });
  const auto upward = through(*channel, knots, [](const Channel::Section& at) -> Vec2 { return Vec2(at.factor[1], 0); });
  for (int i = 0; i < wall.n_along; ++i)
    for (int k = 0; k < wall.n_around; ++k)
      wall.net.row(i * wall.n_around + k) << (centre[i] + ring[k][0] * across[i]).transpose(), ring[k][1] * upward[i][0];
  wall.outline = scaled(channel->outline(channel->start()).spline(azimuthal_elements), Vec2::Constant(wider));
  if (!channel->repeats()) wall.start = channel->start(), wall.end = channel->end();
  wall.channel = std::move(channel);
  return wall;
}

double TubeWall::axial_position(const Vec3& x) const {
  switch (kind) {
    case DuctKind::straight_tube: return x[0];
    case DuctKind::channel: return channel->coordinates(x)[0];
  }
  throw std::logic_error("unknown DuctKind");
}

double tube_length(const TubeOptions& options, double radius, double particle_length) {
  return options.length.value_or(std::max(2 * std::numbers::pi * radius, particle_length + 4.6 * radius));
}

int elements_per_period(const TubeOptions& options, double radius, double period, double half_length) {
  if (options.axial_elements) return *options.axial_elements;
  const double width = std::max(radius, half_length), usual = tube_length({}, radius, 0);
  const auto share = count(period / (2 * width), options.grading) / count(usual / (2 * radius), options.grading) * width / radius;
  return static_cast<int>(std::clamp(std::ceil(options.default_axial_elements() * share - 1e-9), 4., 1e9));
}

void check_length(const TubeWall& wall, double first, double last) {
  const double margin = 1.7 * wall.radius(), needed = 2 * (std::max(-first, last) + margin);
  if (wall.length() >= needed) return;
  throw UserError(
      formatted("Tube/length must be at least %.4g for this particle, which reaches from x1 = %.4g to %.4g relative to its centroid, but is "
                "%.4g: 1.7 R_T = %.4g must be left at either end.",
                needed, first, last, wall.length(), margin));
}

}  // namespace tanktread::surface
