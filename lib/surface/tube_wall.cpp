#include "surface/tube_wall.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "spline/bernstein.hpp"

namespace tanktread::surface {
namespace {

/// Cubic splines in one variable: intervals between knots (pieces) with four functions each, and collocation points, each with all pieces that
/// contain it.
struct Line {
  struct Piece {
    std::array<int, 4> functions;
    Eigen::Matrix4d extraction;  ///< row: function; column: Bernstein polynomial
  };
  int n = 0;
  std::vector<Piece> pieces;
  std::vector<std::vector<std::pair<int, double>>> sites;

  /// Adds a collocation point at u, given the knots of the pieces from index `first` on.
  void add_site(double u, const std::vector<double>& knots, int first, bool closed) {
    const int m = static_cast<int>(knots.size()) - 1;
    const double tiny = 1e-9 * (knots[m] - knots[0]);
    std::vector<std::pair<int, double>> at;
    int piece = first;
    for (int e = 0; e < m; ++e) {
      if (knots[e] == knots[e + 1]) continue;
      if (u > knots[e] - tiny && u < knots[e + 1] + tiny) at.emplace_back(piece, std::clamp((u - knots[e]) / (knots[e + 1] - knots[e]), 0., 1.));
      ++piece;
    }
    if (closed && std::abs(u - knots[0]) <= tiny) at.emplace_back(first + m - 1, 1.);
    for (auto& [e, s] : at)
      for (const double end : {0., 1.})
        if (std::abs(s - end) < 1e-9) s = end;
    sites.push_back(std::move(at));
  }

  /// Adds the pieces between the knots. The function that begins at knot j of `extended` has the index number(j).
  template <class Number>
  void add_pieces(const std::vector<double>& extended, int m, const Number& number) {
    for (int e = 0; e < m; ++e) {
      if (extended[e + 3] == extended[e + 4]) continue;
      Piece piece;
      for (int a = 0; a < 4; ++a) {
        std::array<double, 5> k;
        std::copy_n(extended.begin() + e + a, 5, k.begin());
        const std::array<double, 4> values = spline::b_spline_on(k, extended[e + 3], extended[e + 4]);
        for (int b = 0; b < 4; ++b) piece.extraction(a, b) = values[b];
        piece.functions[a] = number(e + a);
      }
      pieces.push_back(piece);
    }
  }
};

/// Adds the splines with the given knots. If `closed`, they are periodic, and the middle knot of function i is knots[i]. Otherwise the end knots
/// have multiplicity four. If `inwards`, the collocation points at the two ends are moved halfway to their neighbours.
void add(Line& line, const std::vector<double>& knots, bool closed, bool inwards) {
  const int m = static_cast<int>(knots.size()) - 1, n = closed ? m : m + 3, first = static_cast<int>(line.pieces.size()), offset = line.n;
  const double period = knots[m] - knots[0];
  std::vector<double> extended, greville;
  for (int k = -3; k <= m + 3; ++k)
    extended.push_back(closed ? knots[(k + m) % m] + period * std::floor(static_cast<double>(k) / m) : knots[std::clamp(k, 0, m)]);
  line.add_pieces(extended, m, [&](int j) { return offset + (closed ? (j - 1 + m) % m : j); });
  for (int i = closed ? 1 : 0; i < n + closed; ++i) {
    const double u = (extended[i + 1] + extended[i + 2] + extended[i + 3]) / 3;
    greville.push_back(closed && u < knots[0] - 1e-9 * period ? u + period : u);
  }
  if (inwards) {
    greville[0] = (greville[0] + greville[1]) / 2;
    greville[n - 1] = (greville[n - 1] + greville[n - 2]) / 2;
  }
  for (const double u : greville) line.add_site(u, knots, first, closed);
  line.n += n;
}

/// Returns the integral of the element density 1 + (g - 1)/(1 + x^4) from 0 to x, where g is `grading`.
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

std::vector<std::vector<spline::Site>> sites_of(const Line& along, const Line& around) {
  std::vector<std::vector<spline::Site>> all;
  for (const auto& in_s : along.sites)
    for (const auto& in_t : around.sites) {
      std::vector<spline::Site>& sites = all.emplace_back();
      for (const auto& [i, s] : in_s)
        for (const auto& [k, t] : in_t) sites.push_back({i * static_cast<int>(around.pieces.size()) + k, s, t});
    }
  return all;
}

spline::Space product(const Line& along, const Line& around) {
  spline::Space space;
  space.n_points = along.n * around.n;
  const int m = static_cast<int>(around.pieces.size());
  for (std::size_t i = 0; i < along.pieces.size(); ++i)
    for (int k = 0; k < m; ++k) {
      const Line::Piece &s = along.pieces[i], &t = around.pieces[k];
      spline::Element element;
      Eigen::MatrixXd extraction(16, 16);
      element.origin = {static_cast<double>(i), static_cast<double>(k)};
      for (int b = 0; b < 4; ++b)
        for (int a = 0; a < 4; ++a) {
          element.points.push_back(s.functions[a] * around.n + t.functions[b]);
          for (int q = 0; q < 4; ++q)
            for (int p = 0; p < 4; ++p) extraction(4 * b + a, 4 * q + p) = s.extraction(a, p) * t.extraction(b, q);
        }
      element.extraction = std::make_shared<const Eigen::MatrixXd>(std::move(extraction));
      space.elements.push_back(std::move(element));
    }
  space.collocation = sites_of(along, around);
  spline::share_extraction(std::array{&space});
  return space;
}

/// Makes the densities on a wall periodic along x1. `knots`: knots of the periodic splines along x1, except the last one. `open`: the open splines
/// of the wall's geometry, with the same elements, except that the seam between the end and the start of the period divides the last element into
/// two; open.pieces[0] is its second part.
void repeat(TubeWall& wall, Line open, const Line& around, const std::vector<double>& knots) {
  const double period = wall.end - wall.start;
  std::vector<double> ends{wall.start}, cycle = knots;
  ends.insert(ends.end(), knots.begin(), knots.end());
  ends.push_back(wall.end), cycle.push_back(knots.front() + period);
  Line closed;
  add(closed, cycle, true, false);
  open.sites.clear();
  for (int i = 0; i < closed.n; ++i) {  // Greville points, as in add()
    const auto knot = [&](int k) { return cycle[static_cast<std::size_t>((k + closed.n) % closed.n)] + period * std::floor(1. * k / closed.n); };
    const double u = (knot(i - 1) + knot(i) + knot(i + 1)) / 3;
    open.add_site(u < wall.start ? u + period : u >= wall.end ? u - period : u, ends, 0, false);
  }
  wall.sites = sites_of(open, around);
  const int last = static_cast<int>(closed.pieces.size()) - 1, m = static_cast<int>(around.pieces.size());
  // fraction of the last periodic element that lies before the end of the wall
  const double seam = (wall.end - knots.back()) / (cycle.back() - knots.back());
  const auto fill = [&](int piece, int of_closed, double from, double to) {
    const Line::Piece &here = open.pieces[static_cast<std::size_t>(piece)], &there = closed.pieces[static_cast<std::size_t>(of_closed)];
    const Eigen::Matrix4d values = there.extraction * spline::restriction(3, from, to).transpose();
    return std::pair(here, Eigen::Matrix4d(here.extraction.transpose().inverse() * values.transpose()));
  };
  Eigen::MatrixXd e = Eigen::MatrixXd::Zero(open.n, closed.n);
  for (int piece = 0; piece <= last + 1; ++piece) {
    const int of_closed = piece == 0 ? last : piece - 1;
    const auto [here, part] = piece == 0 ? fill(piece, last, seam, 1) : fill(piece, of_closed, 0, piece == last + 1 ? seam : 1);
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b) e(here.functions[a], closed.pieces[static_cast<std::size_t>(of_closed)].functions[b]) = part(a, b);
    for (int k = 0; k < m; ++k) wall.middle_of.push_back((piece == last + 1 ? 0 : piece) * m + k);
    if (piece > last) continue;
    const double middle = piece == 0 ? (0.5 - seam) / (1 - seam) : 0.5;
    for (int k = 0; k < m; ++k) wall.middles.push_back({piece * m + k, middle, 0.5});
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < open.n; ++i)
    for (int j = 0; j < closed.n; ++j)
      for (int k = 0; k < around.n && std::abs(e(i, j)) > 1e-15; ++k) entries.emplace_back(i * around.n + k, j * around.n + k, e(i, j));
  wall.open_from_periodic.resize(open.n * around.n, closed.n * around.n);
  wall.open_from_periodic.setFromTriplets(entries.begin(), entries.end());
  wall.period = period;
}

/// Returns a wall without its control points, and the control points of the outline. `periodic`: knots of the periodic splines for densities, all
/// of them between the first and the last of `knots`; empty if the wall is not periodic.
std::pair<TubeWall, std::vector<Vec2>> woven(const Outline& section, const std::vector<double>& knots, int azimuthal_elements,
                                             const std::vector<double>& periodic = {}) {
  Line along, around;
  add(along, knots, false, false);
  TubeWall wall{.space = {}, .net = {}, .outline = section.spline(azimuthal_elements), .start = knots.front(), .end = knots.back()};
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
    repeat(wall, std::move(along), around, periodic);
  } else {
    wall.sites = wall.space.collocation;
    for (int e = 0; e < static_cast<int>(wall.space.elements.size()); ++e) wall.middles.push_back({e, 0.5, 0.5}), wall.middle_of.push_back(e);
  }
  return {std::move(wall), std::move(ring)};
}

}  // namespace

namespace {

TubeWall straight_wall(const Outline& section, int azimuthal_elements, const std::vector<double>& knots, const std::vector<double>& periodic) {
  auto [wall, ring] = woven(section, knots, azimuthal_elements, periodic);
  wall.space.description = "tube, " + wall.space.description;
  const int last = static_cast<int>(knots.size()) - 1;
  const auto knot = [&](int i) { return knots[static_cast<std::size_t>(std::clamp(i, 0, last))]; };
  for (int i = 0; i < wall.n_along; ++i) {
    // x1 coordinates of the control points (Greville points), with which x1 is a linear function
    const double place = (knot(i - 2) + knot(i - 1) + knot(i)) / 3;
    for (int k = 0; k < wall.n_around; ++k)
      wall.net.row(i * wall.n_around + k) << place, ring[k][0], ring[k][1];
  }
  wall.widest = std::max(knot(last / 2 + 1) - knot(last / 2), wall.outline.length() / azimuthal_elements);
  return std::move(wall);
}

}  // namespace

TubeWall tube_wall(const Outline& section, const TubeOptions& options, double length, double half_length) {
  const int elements = options.axial_elements.value_or(TubeOptions::default_axial_elements);
  const double width = std::max(section.radius(), half_length);
  return straight_wall(section, options.azimuthal_elements, graded_knots(length, elements, options.grading, width), {});
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

/// Returns the control points of the spline that interpolates a quantity of a channel's sections, with given slopes at the ends and at triple
/// knots.
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
  if (channel->repeats()) {  // the wall ends, one period after its start, at a quarter of the last periodic element
    periodic.assign(knots.begin(), knots.end() - 1);
    const double before = 0.75 * (knots.back() - periodic.back());
    knots.insert(knots.begin(), knots.front() - before);
    knots.back() -= before;
  }
  auto [wall, ring] = woven(channel->outline(), knots, azimuthal_elements, periodic);
  wall.space.description = "channel, " + wall.space.description;
  // scales the spline approximation of the outline to the exact area
  const double wider = std::sqrt(channel->outline().area() / wall.outline.area());
  for (Vec2& point : ring) point *= wider;
  double narrowest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < knots.size(); ++k) {
    const Channel::Section at = channel->at(knots[k]);
    if (k == 0 || at.factor.minCoeff() > narrowest) continue;
    const double widest = std::max(knots[k] - knots[k - 1], wall.outline.length() * at.factor.minCoeff() / azimuthal_elements);
    // equally narrow sections: the smallest, because elements are longer at the ends of a straight channel
    wall.widest = at.factor.minCoeff() < narrowest ? widest : std::min(wall.widest, widest);
    narrowest = at.factor.minCoeff();
  }
  const auto centre = through(*channel, knots, [](const Channel::Section& at) -> Vec2 { return at.centre.head<2>(); });
  const auto across = through(*channel, knots, [](const Channel::Section& at) -> Vec2 { return at.factor[0] * at.across.head<2>(); });
  const auto upward = through(*channel, knots, [](const Channel::Section& at) -> Vec2 { return Vec2(at.factor[1], 0); });
  for (int i = 0; i < wall.n_along; ++i)
    for (int k = 0; k < wall.n_around; ++k)
      wall.net.row(i * wall.n_around + k) << (centre[i] + ring[k][0] * across[i]).transpose(), ring[k][1] * upward[i][0];
  wall.outline = scaled(channel->outline(channel->start()).spline(azimuthal_elements), Vec2::Constant(wider));
  if (!channel->repeats()) wall.start = channel->start(), wall.end = channel->end();
  wall.channel = std::move(channel);
  return wall;
}

double tube_length(const TubeOptions& options, double radius, double particle_length) {
  return options.length.value_or(std::max(2 * std::numbers::pi * radius, particle_length + 4.6 * radius));
}

int elements_per_period(const TubeOptions& options, double radius, double period, double half_length) {
  if (options.axial_elements) return *options.axial_elements;
  const double width = std::max(radius, half_length), usual = tube_length({}, radius, 0);
  const auto share = count(period / (2 * width), options.grading) / count(usual / (2 * radius), options.grading) * width / radius;
  return static_cast<int>(std::clamp(std::ceil(TubeOptions::default_axial_elements * share - 1e-9), 4., 1e9));
}

void check_length(const TubeWall& wall, double first, double last) {
  const double margin = 1.7 * wall.radius(), needed = 2 * (std::max(-first, last) + margin);
  if (wall.length() >= needed) return;
  throw UserError(
      formatted("Tube/length must be at least %.4g for this particle, which reaches from x1 = %.4g to %.4g seen from its centroid, but is "
                "%.4g: 1.7 R_T = %.4g must be left at either end.",
                needed, first, last, wall.length(), margin));
}

}  // namespace tanktread::surface
