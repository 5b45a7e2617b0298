#include "surface/walls/outline.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "base/indices.hpp"
#include "quadrature/gauss.hpp"

namespace tanktread::surface {
namespace {

constexpr int chords_per_piece = 8, chords_of_ellipse = 128;

std::vector<double> chord_ends(const PlaneCurve& curve) {
  std::vector<double> out;
  if (const auto* cubic = std::get_if<CubicCurve>(&curve)) {
    for (std::size_t e = 0; e + 1 < cubic->breaks.size(); ++e)
      for (int i = 0; i < chords_per_piece; ++i)
        out.push_back(cubic->breaks[e] + (cubic->breaks[e + 1] - cubic->breaks[e]) * i / chords_per_piece);
    out.push_back(cubic->breaks.back());
  } else {
    for (int i = 0; i <= chords_of_ellipse; ++i) out.push_back(2 * std::numbers::pi * i / chords_of_ellipse);
  }
  return out;
}

/// Returns an upper bound of |x''| for begin <= u <= end. On a cubic curve, this range must lie in one piece, where x'' is linear.
double bend(const PlaneCurve& curve, double begin, double end) {
  if (const auto* ellipse = std::get_if<Ellipse>(&curve)) return ellipse->semi_axes.maxCoeff();
  const double inside = 1e-9 * (end - begin);
  return std::max(jet(curve, begin + inside).dd.norm(), jet(curve, end - inside).dd.norm());
}

/// Returns the parameter (0 at a, 1 at b) of the point of the segment from a to b that is nearest to p.
double foot(const Vec2& p, const Vec2& a, const Vec2& b) {
  const Vec2 along = b - a;
  return std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
}

/// Returns a common point of the segment from a to b and the segment from c to d; nothing if there is none.
std::optional<Vec2> meeting(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  const auto apart = [&](int k) { return std::max(a[k], b[k]) < std::min(c[k], d[k]) || std::max(c[k], d[k]) < std::min(a[k], b[k]); };
  if (apart(0) || apart(1)) return std::nullopt;
  const double from_c = cross(b - a, c - a), from_d = cross(b - a, d - a);
  if (from_c * from_d > 0 || cross(d - c, a - c) * cross(d - c, b - c) > 0) return std::nullopt;
  return from_c == from_d ? c : Vec2(c + from_c / (from_c - from_d) * (d - c));
}

}  // namespace

Outline::Outline(std::vector<PlaneCurve> sides, const std::string& name) : sides_(std::move(sides)) {
  for (int k = 0; k < n_sides(); ++k) add_chords(k);
  measure();
  if (const auto crossing = first_crossing())
    throw UserError(name + " crosses itself near (x2, x3) = " + formatted("(%.4g, %.4g)", (*crossing)[0], (*crossing)[1]) + ".");
  if (area_ <= 0) throw UserError(name + " must run counter-clockwise, from x2 towards x3, but runs clockwise.");
}

void Outline::add_chords(int k) {
  const auto ends = chord_ends(side(k));
  for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
    const double h = ends[i + 1] - ends[i];
    const Vec2 last = closed(side(k)) && i + 2 == ends.size() ? point(k, ends[0]) : point(k, ends[i + 1]);
    chords_.push_back({k, ends[i], ends[i + 1], point(k, ends[i]), last, bend(side(k), ends[i], ends[i + 1]) * h * h / 8});
  }
}

void Outline::measure() {
  const auto& rule = quadrature::gauss(6);
  lengths_.assign(sides_.size(), 0);
  box_ = {chords_[0].a, chords_[0].a};
  Vec2 moment = Vec2::Zero();
  for (const Chord& chord : chords_) {
    const double h = chord.end - chord.begin;
    for (int q = 0; q < rule.size(); ++q) {
      const PlaneJet j = at(chord.side, chord.begin + h * rule.nodes[q]);
      const double w = h * rule.weights[q];
      lengths_[static_cast<std::size_t>(chord.side)] += w * j.d.norm();
      area_ += w * cross(j.x, j.d) / 2;
      moment += w * cross(j.x, j.d) / 3 * j.x;
    }
    box_[0] = box_[0].cwiseMin(chord.a.array().matrix() - Vec2::Constant(chord.sag));
    box_[1] = box_[1].cwiseMax(chord.a.array().matrix() + Vec2::Constant(chord.sag));
    sag_ = std::max(sag_, chord.sag);
  }
  centroid_ = moment / area_;
  length_ = std::accumulate(lengths_.begin(), lengths_.end(), 0.0);
}

/// Returns a common point of two chords that are not neighbours; nothing if there is none. Sweeps along x2, so that only chords whose ranges of x2
/// overlap are compared.
std::optional<Vec2> Outline::first_crossing() const {
  const auto low = [](const Chord& c) { return std::min(c.a[0], c.b[0]); };
  const int n = static_cast<int>(chords_.size());
  std::vector<int> order = indices(chords_.size());
  std::sort(order.begin(), order.end(), [&](int i, int j) { return low(chord(i)) < low(chord(j)); });
  for (int i = 0; i < n; ++i) {
    const int one = order[static_cast<std::size_t>(i)];
    const Chord& first = chord(one);
    for (int j = i + 1; j < n; ++j) {
      const int other = order[static_cast<std::size_t>(j)], between = std::abs(one - other);
      const Chord& second = chord(other);
      if (low(second) > std::max(first.a[0], first.b[0])) break;
      if (between == 1 || between == n - 1) continue;
      if (const auto place = meeting(first.a, first.b, second.a, second.b)) return place;
    }
  }
  return std::nullopt;
}

Vec2 Outline::normal(int k, double u) const {
  const Vec2 t = tangent(k, u);
  return {t[1], -t[0]};
}

double Outline::corner_angle(int k) const {
  if (smooth()) return std::numbers::pi;
  const int before = (k + n_sides() - 1) % n_sides();
  const Vec2 in = tangent(before, range(side(before))[1]), out = tangent(k, range(side(k))[0]);
  return std::numbers::pi - std::atan2(cross(in, out), in.dot(out));
}

double Outline::radius() const { return std::sqrt(area_ / std::numbers::pi); }

/// Finds the point nearest to p on the part of the curve that belongs to the chord: the foot of the perpendicular by Newton's method, or an end
/// point.
Nearest Outline::nearest_on(const Chord& chord, const Vec2& p) const {
  const double h = chord.end - chord.begin;
  double u = chord.begin + h * foot(p, chord.a, chord.b);
  for (int k = 0; k < 20; ++k) {
    const PlaneJet j = at(chord.side, u);
    const double squared = j.d.squaredNorm(), slope = squared + (j.x - p).dot(j.dd), before = u;
    u = std::clamp(u - (j.x - p).dot(j.d) / (slope > 0 ? slope : squared), chord.begin, chord.end);
    if (std::abs(u - before) < 1e-14 * h) break;
  }
  Nearest best;
  best.distance = std::numeric_limits<double>::infinity();
  for (const double candidate : {u, chord.begin, chord.end}) {
    const Vec2 x = point(chord.side, candidate);
    if (const double d = (x - p).norm(); d < best.distance) best = {chord.side, candidate, x, d};
  }
  return best;
}

double Outline::distance_to(const Chord& chord, const Vec2& p) { return (chord.a + foot(p, chord.a, chord.b) * (chord.b - chord.a) - p).norm(); }

Nearest Outline::nearest(const Vec2& p) const {
  double bound = std::numeric_limits<double>::infinity();
  std::vector<double> distances;
  distances.reserve(chords_.size());
  for (const Chord& c : chords_) {
    distances.push_back(distance_to(c, p));
    bound = std::min(bound, distances.back() + c.sag);
  }
  Nearest best;
  best.distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < chords_.size(); ++i) {
    if (distances[i] - chords_[i].sag > bound) continue;
    if (const Nearest candidate = nearest_on(chords_[i], p); candidate.distance < best.distance) best = candidate;
  }
  if (!within(p, best)) best.distance = -best.distance;
  return best;
}

/// Returns the point of the outline nearest to p, where p is within the distance r of the point x. `its`: the point of the outline nearest to x. A
/// point y of the outline with |y - x|^2 - |its - x|^2 > 2 r |y - its| is farther from p than `its`. Chords that contain only such points are
/// skipped.
Nearest Outline::nearest_around(const Vec2& x, const Nearest& its, double r, const Vec2& p) const {
  Nearest best;
  best.distance = std::numeric_limits<double>::infinity();
  for (const Chord& c : chords_) {
    const double near = std::max(distance_to(c, x) - c.sag, 0.), along = std::max((c.a - its.x).norm(), (c.b - its.x).norm()) + c.sag;
    if (near * near - its.distance * its.distance > 2 * r * along || distance_to(c, p) - c.sag > best.distance) continue;
    if (const Nearest candidate = nearest_on(c, p); candidate.distance < best.distance) best = candidate;
  }
  return best;
}

/// Returns whether p is inside the polygon of the chords, which approximates the outline. If p is so close to the outline that polygon and outline
/// may differ, returns instead whether p lies behind the outward normal at `nearest`, the point of the outline nearest to p.
bool Outline::within(const Vec2& p, const Nearest& nearest) const {
  if (nearest.distance <= 2 * sag_) {
    Vec2 out = normal(nearest.side, nearest.u);
    const auto [first, last] = range(side(nearest.side));
    if (!smooth() && nearest.u == first) {
      const int before = (nearest.side + n_sides() - 1) % n_sides();
      out += normal(before, range(side(before))[1]);
    } else if (!smooth() && nearest.u == last) {
      const int after = (nearest.side + 1) % n_sides();
      out += normal(after, range(side(after))[0]);
    }
    return (p - nearest.x).dot(out) < 0;
  }
  bool odd = false;
  for (const Chord& c : chords_) {
    if ((c.a[1] > p[1]) == (c.b[1] > p[1])) continue;
    if (p[0] < c.a[0] + (c.b[0] - c.a[0]) * (p[1] - c.a[1]) / (c.b[1] - c.a[1])) odd = !odd;
  }
  return odd;
}

std::vector<int> Outline::shares(int elements, int least) const {
  std::vector<int> out(sides_.size(), least);
  constexpr double slack = 1e-12;
  for (int rest = elements - least * n_sides(); rest > 0;) {
    int longest = 0;
    const auto size = [&](int k) { return side_length(k) / out[static_cast<std::size_t>(k)]; };
    for (int k = 1; k < n_sides(); ++k)
      if (size(k) > size(longest) * (1 + slack)) longest = k;
    for (int k = 0; k < n_sides(); ++k)
      if (std::abs(side_length(k) - side_length(longest)) <= slack * side_length(longest)) ++out[static_cast<std::size_t>(k)], --rest;
  }
  return out;
}

std::vector<double> Outline::knots(int k, int m) const {
  const auto [first, last] = range(side(k));
  std::vector<double> out;
  for (int i = 0; i <= m; ++i) out.push_back(first + (last - first) * i / m);
  return out;
}

Outline Outline::spline(int elements) const {
  std::vector<PlaneCurve> out;
  const auto share = shares(elements, smooth() ? 3 : 2);
  for (int k = 0; k < n_sides(); ++k) {
    const auto breaks = knots(k, share[static_cast<std::size_t>(k)]);
    std::vector<Vec2> points;
    for (const double u : breaks) points.push_back(point(k, u));
    if (closed(side(k))) {
      points.pop_back();
      out.push_back(interpolate_closed(breaks, points));
    } else {
      out.push_back(interpolate_open(breaks, points, at(k, breaks.front()).d, at(k, breaks.back()).d));
    }
  }
  return Outline(std::move(out));
}

}  // namespace tanktread::surface
