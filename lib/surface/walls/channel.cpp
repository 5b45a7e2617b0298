#include "surface/walls/channel.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/table.hpp"
#include "deck/words.hpp"

namespace tanktread::surface {
namespace {

using std::numbers::pi;

constexpr int n_samples = 4000;
// least length of a straight end of the channel divided by the tube radius R_T; perturbations of the flow decay to 1e-5 of their size over this
// length
constexpr double straight_end = 1.7;

std::logic_error unknown_profile(const std::string& profile) { return std::logic_error("Channel/profile " + profile + " has no scale factors"); }

}  // namespace

Outline scaled(const Outline& outline, const Vec2& factor) {
  std::vector<PlaneCurve> sides;
  for (int k = 0; k < outline.n_sides(); ++k) {
    PlaneCurve side = outline.side(k);
    if (auto* ellipse = std::get_if<Ellipse>(&side)) {
      ellipse->centre = ellipse->centre.cwiseProduct(factor);
      ellipse->semi_axes = ellipse->semi_axes.cwiseProduct(factor);
    } else {
      for (auto& piece : std::get<CubicCurve>(side).bezier)
        for (Vec2& point : piece) point = point.cwiseProduct(factor);
    }
    sides.push_back(std::move(side));
  }
  return Outline(std::move(sides), "Channel/section");
}

Channel::Channel(const TubeOptions& options)
    : options_(options), own_(options.channel.value()), outline_(surface::outline(options)) {
  const auto [low, high] = outline_.box();
  for (int d = 0; d < 2; ++d) half_[d] = (high[d] - low[d]) / 2;
  height_ = own_.directions == "x2" ? half_[0] : own_.directions == "x3" ? half_[1] : outline_.radius();
  if (own_.points) read_points();
  find_ends();
  check();
}

/// Reads the scale factors of the cross-section from the table Channel/points, which has rows s,f or s,f2,f3 (arc length and factors).
void Channel::read_points() {
  const std::string name = "Channel/points \"" + deck::shortened(own_.points->path, 80) + "\"";
  std::vector<double> s;
  std::vector<Vec2> factor;
  for (const deck::TableRow& row : deck::read_table(*own_.points, name, {{{"s", "length"}, {"f2", "1", true}, {"f3", "1"}}, {2, 3}})) {
    const std::string here = name + formatted(", line %d: ", row.line);
    const double at = row.numbers[0];
    if (!s.empty() && at <= s.back()) throw UserError(here + formatted("s must ascend, but %g comes after %g.", at, s.back()));
    s.push_back(at);
    factor.emplace_back(row.numbers[1], row.numbers.back());
    if (own_.directions == "x2") factor.back()[1] = 1;
    if (own_.directions == "x3") factor.back()[0] = 1;
    if (options_.repulsion && factor.back()[0] != factor.back()[1])
      throw UserError(here + "Channel/repulsion needs circular cross-sections, with equal factors f2 and f3.");
  }
  if (s.size() < 2) throw UserError(name + " must hold at least two rows.");
  factors_ = interpolate_open(s, factor, Vec2::Zero(), Vec2::Zero());
}

/// If the profile is `step`, returns the length of the wall contour from the middle of the step to one end of the channel, minus the length of the
/// centre line between them. Returns 0 for other profiles.
double Channel::jump() const {
  if (own_.profile != "step") return 0;
  return std::abs(*own_.depth) * height_ + (pi - 4) * *own_.corner_radius;
}

void Channel::find_ends() {
  const double radius = outline_.radius();
  bool changes = false;
  const auto take = [&](double low, double high) {
    first_ = changes ? std::min(first_, low) : low, last_ = changes ? std::max(last_, high) : high;
    changes = true;
  };
  if (factors_) take(factors_->breaks.front(), factors_->breaks.back());
  if (own_.half_length) take(-*own_.half_length - own_.corner_radius.value_or(0), *own_.half_length + own_.corner_radius.value_or(0));
  if (own_.bend_radius) take(own_.bend_start, own_.bend_start + *own_.bend_radius * own_.bend_angle * pi / 180);
  // radius at an end of the profile; only profiles of a file end with other cross-sections than the given outline
  const auto radius_at = [&](double s) { return factors_ ? radius * std::sqrt(std::max(0., section(s).factor.prod())) : radius; };
  start_ = own_.start.value_or(first_ - 4 * radius_at(first_)), end_ = own_.end.value_or(last_ + 4 * radius_at(last_));
  if (options_.period == 0) return;
  start_ = (first_ + last_ - options_.period) / 2, end_ = start_ + options_.period;
}

void Channel::check() {
  const double radius = outline_.radius();
  if (own_.profile == "step") {
    const double rise = std::abs(*own_.depth) * height_, edge = *own_.corner_radius, most = std::min(rise / 2, *own_.half_length);
    if (edge > most)
      throw UserError(formatted("Channel/corner radius must be at most %.4g for a step of height %.4g and half length %.4g, but is %.4g.", most, rise,
                                *own_.half_length, edge));
  }
  double inwards = 0;  // largest distance of the wall from the centre line on the side to which the centre line bends
  for (int k = 0; k <= n_samples; ++k) {
    const double s = start_ + (end_ - start_) * k / n_samples;
    const Vec2 factor = section(s).factor;
    for (int d = 0; d < 2; ++d) {
      const double width = half_[d] * factor[d];
      if (!(width > 0.01 * radius))
        throw UserError(formatted("The channel is closed at s = %.4g: half its width along x%d is %.3g, and must be more than 0.01 R_T = %.3g.", s,
                                  d + 2, width, 0.01 * radius));
      smallest_ = k + d == 0 ? width : std::min(smallest_, width);
    }
    inwards = std::max(inwards, outline_.box()[1][0] * factor[0]);
  }
  const double before = start_ + straight_end * outline(start_).radius(), after = end_ - straight_end * outline(end_).radius();
  if (options_.period > 0)
    check_period();
  else if (start_ >= end_ || (last_ > first_ && (before > first_ || after < last_)))
    throw UserError(
        formatted("Channel/start and Channel/end must leave straight ends of 1.7 R_T = %.4g: the channel changes from s = %.4g to %.4g, "
                  "but the computed part extends from %.4g to %.4g.",
                  straight_end * std::max(outline(start_).radius(), outline(end_).radius()), first_, last_, start_, end_));
  if (own_.bend_radius && *own_.bend_radius <= 1.05 * inwards)
    throw UserError(
        formatted("Channel/bend radius must exceed the width of the channel from its centre line to the inner wall of the bend, %.4g, by at least "
                  "5 %%, because otherwise its cross-sections intersect, but is %.4g.",
                  inwards, *own_.bend_radius));
}

void Channel::check_period() {
  if (own_.start || own_.end)
    throw UserError("Channel/start and Channel/end are for a channel with two ends, but Domain makes it periodic along x1.");
  if (own_.bend_radius)
    throw UserError("Channel/bend radius is for a channel with two ends: a channel with a bend is not periodic along x1.");
  if (last_ - first_ > options_.period * (1 + 1e-9))
    throw UserError(
        formatted("The period of the channel, Domain/side lengths %.4g, must be at least as long as the part in which its cross-section "
                  "changes, from s = %.4g to %.4g.",
                  options_.period, first_, last_));
  const Vec2 jumps = place(start_).factor - place(end_).factor;
  if (jumps.cwiseAbs().maxCoeff() > 1e-6)
    throw UserError(
        formatted("A periodic channel must have the same cross-section at both ends of its period, but its factors differ by %.3g.",
                  jumps.cwiseAbs().maxCoeff()));
}

/// Returns the equivalent arc length in the modelled period: s plus a multiple of the period. If the channel is not periodic, returns s.
double Channel::in_period_along(double s) const {
  return options_.period > 0 ? s - options_.period * std::floor((s - start_) / options_.period) : s;
}

/// Returns the arc length and the scale factors at the longitudinal parameter u, which may be beyond the modelled period of a periodic channel.
Channel::SectionParameters Channel::in_period(double u) const {
  if (options_.period == 0) return place(u);
  const double low = parameter(start_), whole = parameter(end_) - low, periods = std::floor((u - low) / whole);
  SectionParameters at = place(u - periods * whole);
  at.s += periods * options_.period;
  return at;
}

/// Returns the centre line's arc length and the scale factors at arc length u of the wall contour of the profile `step`. From its middle u = 0, the
/// contour has a straight part, a rounded edge, a straight part across the channel, an edge rounded in the opposite direction, and a straight part.
Channel::SectionParameters Channel::step(double u) const {
  const double w = *own_.half_length, edge = *own_.corner_radius, depth = *own_.depth;
  const double inner = height_ * (1 - depth), up = depth > 0 ? 1 : -1, across = std::abs(depth) * height_ - 2 * edge, arc = pi / 2 * edge;
  double a = std::abs(u) - (w - edge), s = std::abs(u), h = inner;
  if (a > 0 && a < arc) {
    s = w - edge + edge * std::sin(a / edge), h = inner + up * edge * (1 - std::cos(a / edge));
  } else if (a >= arc && a < arc + across) {
    s = w, h = inner + up * (edge + a - arc);
  } else if (a >= arc + across) {
    a -= arc + across;
    const double t = std::min(a / edge, pi / 2);
    s = w + edge * (1 - std::cos(t)) + std::max(a - arc, 0.), h = height_ - up * edge * (1 - std::sin(t));
  }
  return {std::copysign(s, u), Vec2::Constant(h / height_)};
}

Channel::SectionParameters Channel::place(double u) const {
  SectionParameters at{u, Vec2::Ones()};
  if (factors_) {
    const double inside = std::clamp(u, factors_->breaks.front(), factors_->breaks.back());
    at.factor = jet(*factors_, inside).x;
  } else if (own_.profile == "step") {
    at = step(u);
  } else if (own_.profile == "constriction" || own_.profile == "expansion") {
    if (std::abs(u) < own_.half_length.value()) {
      const double bump = *own_.depth * (1 + std::cos(pi * u / *own_.half_length)) / 2;
      at.factor.setConstant(own_.profile == "expansion" ? 1 + bump : 1 - bump);
    }
  } else if (own_.profile != "straight") {
    throw unknown_profile(own_.profile);
  }
  if (own_.directions == "x2") at.factor[1] = 1;
  if (own_.directions == "x3") at.factor[0] = 1;
  return at;
}

double Channel::parameter(double s) const {
  if (own_.profile != "step") return s;
  double low = std::min(s, -std::abs(s) - jump()), high = -low;
  for (int k = 0; k < 60; ++k) (place((low + high) / 2).s < s ? low : high) = (low + high) / 2;
  return (low + high) / 2;
}

Channel::Section Channel::section_of(const SectionParameters& at) const {
  const double begin = own_.bend_start;
  if (!own_.bend_radius || at.s <= begin) return {Vec3(at.s, 0, 0), Vec3::UnitX(), Vec3::UnitY(), at.factor};
  const double r = *own_.bend_radius, all = own_.bend_angle * pi / 180, angle = std::min((at.s - begin) / r, all), rest = at.s - begin - r * angle;
  const Vec3 along(std::cos(angle), std::sin(angle), 0), normal(-along[1], along[0], 0);
  return {Vec3(begin, r, 0) - r * normal + rest * along, along, normal, at.factor};
}

Channel::Section Channel::at(double u) const { return section_of(in_period(u)); }

Channel::Section Channel::section(double s) const {
  SectionParameters at = place(parameter(in_period_along(s)));
  if (options_.period > 0) at.s = s;
  return section_of(at);
}

Vec3 Channel::coordinates(const Vec3& x) const {
  double s = x[0], y = x[1];
  if (own_.bend_radius && (s > own_.bend_start || y > *own_.bend_radius)) {
    const double begin = own_.bend_start, r = *own_.bend_radius, all = own_.bend_angle * pi / 180;
    const double angle = std::atan2(s - begin, r - y);
    if (angle >= 0 && angle <= all) {
      y = r - std::hypot(s - begin, r - y);
      s = begin + r * angle;
    } else {
      const Section after = section(begin + r * all);
      y = (x - after.centre).dot(after.normal);
      s = begin + r * all + (x - after.centre).dot(after.along);
    }
  }
  const Vec2 factor = place(parameter(in_period_along(s))).factor;
  return {s, y / factor[0], x[2] / factor[1]};
}

bool Channel::inside(const Vec3& x) const {
  const Vec3 at = coordinates(x);
  return (options_.period > 0 || (at[0] > start_ && at[0] < end_)) && outline_.inside(at.tail<2>());
}

Outline Channel::outline(double s) const { return scaled(outline_, section(s).factor); }

TubeOptions Channel::tube(double s) const {
  TubeOptions tube = options_;
  tube.channel.reset();
  const Vec2 factor = section(s).factor;
  if (tube.section == "circle" && factor[0] == factor[1]) {
    tube.radius = tube.radius.value() * factor[0];
  } else if (tube.section == "circle") {
    tube.section = "ellipse";
    tube.semi_axes = tube.radius.value() * factor;
    tube.radius.reset();
  } else if (tube.section == "ellipse") {
    tube.semi_axes = tube.semi_axes.value().cwiseProduct(factor);
  } else if (tube.section == "rectangle") {
    tube.sides = tube.sides.value().cwiseProduct(factor);
  } else if (tube.section != "file") {  // a file is not scaled: the outline is used instead
    throw std::logic_error("Channel/section " + tube.section + " cannot be scaled");
  }
  return tube;
}

/// Returns evenly spaced values of the longitudinal parameter u, from the start to the end of the channel.
std::vector<double> Channel::lines() const {
  const double low = parameter(start_), high = parameter(end_);
  std::vector<double> u;
  for (int k = 0; k <= n_samples; ++k) u.push_back(low + (high - low) * k / n_samples);
  return u;
}

/// Returns the values of the longitudinal parameter u at which the curvature of the wall or of the centre line jumps.
std::vector<double> Channel::kinks() const {
  std::vector<double> u;
  if (factors_) {
    u = {factors_->breaks.front(), factors_->breaks.back()};
  } else if (own_.profile == "constriction" || own_.profile == "expansion") {
    u = {-*own_.half_length, *own_.half_length};
  } else if (own_.profile == "step") {
    const double first = *own_.half_length - *own_.corner_radius, arc = pi / 2 * *own_.corner_radius;
    const double across = std::abs(*own_.depth) * height_ - 2 * *own_.corner_radius;
    for (const double v : {first, first + arc, first + arc + across, first + 2 * arc + across}) u.push_back(-v), u.push_back(v);
  } else if (own_.profile != "straight") {
    throw unknown_profile(own_.profile);
  }
  if (!own_.bend_radius) return u;
  u.push_back(parameter(own_.bend_start));
  u.push_back(parameter(own_.bend_start + *own_.bend_radius * own_.bend_angle * pi / 180));
  return u;
}

/// Returns the desired element length at each longitudinal parameter u: three quarters of the width of the elements at u, and less where the wall
/// bends. At distances above 2.5 R_T (tube radius) from the part in which the cross-section or the direction of the channel changes, the length is
/// multiplied by 2.5. Where the curvature jumps, the length is multiplied by 0.25. The length changes by at most 0.3 per unit distance, so that short
/// elements are followed by gradually longer elements.
std::vector<double> Channel::sizes(const std::vector<double>& u) const {
  const double finer = 24. / options_.azimuthal_elements, radius = outline_.radius(), step = u[1] - u[0];
  const bool changes = last_ > first_;
  std::vector<double> size;
  std::vector<SectionParameters> at;
  for (const double v : u) at.push_back(place(v));
  for (std::size_t k = 0; k < u.size(); ++k) {
    double h = 0.75 * outline_.length() / options_.azimuthal_elements * at[k].factor.minCoeff();
    const SectionParameters &before = at[k == 0 ? 0 : k - 1], &after = at[std::min(k + 1, u.size() - 1)];
    const Vec2 in(at[k].s - before.s, height_ * (at[k].factor - before.factor).cwiseAbs().maxCoeff());
    const Vec2 out(after.s - at[k].s, height_ * (after.factor - at[k].factor).cwiseAbs().maxCoeff());
    const double turn = std::abs(std::atan2(in[0] * out[1] - in[1] * out[0], in.dot(out)));
    if (k > 0 && k + 1 < u.size() && turn > 0) h = std::min(h, 0.35 * finer * out.norm() / turn);
    if (own_.bend_radius) h = std::min(h, 0.35 * finer * (*own_.bend_radius - outline_.box()[1][0] * at[k].factor[0]));
    if (changes && (at[k].s < first_ - 2.5 * radius || at[k].s > last_ + 2.5 * radius)) h *= 2.5;
    size.push_back(h);
  }
  for (const double kink : kinks())
    if (const double k = std::round((kink - u[0]) / step); k >= 0 && k < static_cast<double>(size.size())) size[static_cast<std::size_t>(k)] *= 0.25;
  for (std::size_t k = 1; k < u.size(); ++k) size[k] = std::min(size[k], size[k - 1] + 0.3 * step);
  for (std::size_t k = u.size() - 1; k > 0; --k) size[k - 1] = std::min(size[k - 1], size[k] + 0.3 * step);
  return size;
}

int Channel::elements() const {
  if (own_.axial_elements) return *own_.axial_elements;
  const std::vector<double> u = lines(), size = sizes(u);
  double count = 0;
  for (std::size_t k = 1; k < u.size(); ++k) count += (u[k] - u[k - 1]) * (1 / size[k] + 1 / size[k - 1]) / 2;
  return std::max(8, static_cast<int>(std::ceil(count)));
}

/// Returns the knots. Where the curvature of the wall or of the centre line jumps, the knots are triple if there are enough elements. The slope of
/// the wall pressure jumps there, and the shear stress behaves like d log d with the distance d from the jump. Splines that are smooth across the
/// jump would oscillate.
std::vector<double> Channel::knots(int elements) const {
  const std::vector<double> u = lines(), size = sizes(u);
  std::vector<double> count{0};
  for (std::size_t k = 1; k < u.size(); ++k) count.push_back(count.back() + (u[k] - u[k - 1]) * (1 / size[k] + 1 / size[k - 1]) / 2);
  for (double& c : count) c *= elements / count.back();
  const auto between = [](const std::vector<double>& x, const std::vector<double>& y, double at) {
    const auto k = static_cast<std::size_t>(std::lower_bound(x.begin() + 1, x.end() - 1, at) - x.begin());
    return y[k - 1] + (y[k] - y[k - 1]) * (at - x[k - 1]) / (x[k] - x[k - 1]);
  };
  std::vector<double> knots{u.front()};
  double begin = 0;
  int done = 0;
  const auto fill = [&](double last, double end, int whole) {
    for (int i = 1; i < whole - done; ++i) knots.push_back(between(count, u, begin + (end - begin) * i / (whole - done)));
    knots.push_back(last);
    begin = end, done = whole;
  };
  std::vector<double> joints = kinks();
  // Uses no triple knots at the corners of a `step`, because triple knots would fold the sides of the elements on its transverse wall. Simple knots
  // keep the control points apart.
  if (own_.profile == "step")
    std::erase_if(joints, [&](double joint) { return std::abs(place(joint).s) < *own_.half_length + 1.001 * *own_.corner_radius; });
  std::ranges::sort(joints);
  for (const double joint : joints) {
    const double end = between(u, count, joint);
    const auto whole = static_cast<int>(std::lround(end - 1e-6));
    if (whole <= done || whole >= elements) continue;
    fill(joint, end, whole);
    knots.insert(knots.end(), 2, joint);
  }
  fill(u.back(), elements, elements);
  return knots;
}

}  // namespace tanktread::surface
