#include "record/duct_arrays.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "spline/basis.hpp"
#include "surface/geometry.hpp"

namespace tanktread {
namespace {

constexpr int points_around = 400, lines = 121;

std::vector<double> outline_of(const surface::Outline& outline) {
  std::vector<double> out;
  const auto share = outline.shares(points_around);
  for (int k = 0; k < outline.n_sides(); ++k) {
    auto knots = outline.knots(k, share[static_cast<std::size_t>(k)]);
    if (k + 1 < outline.n_sides()) knots.pop_back();
    for (const double u : knots) {
      const surface::Vec2 x = outline.point(k, u);
      out.insert(out.end(), {x[0], x[1]});
    }
  }
  return out;
}

std::vector<double> line(double low, double high) {
  std::vector<double> out;
  for (int i = 0; i < lines; ++i) out.push_back(low + (high - low) * i / (lines - 1));
  return out;
}

/// Returns the velocity v_1 along the tube at all points (x2, x3) of the grid, x2 fastest; NaN outside of the cross-section. One call evaluates all
/// points inside.
std::vector<double> velocities(const stokes::DuctFlow& flow, const std::vector<double>& x2, const std::vector<double>& x3) {
  std::vector<double> out(x2.size() * x3.size(), std::numeric_limits<double>::quiet_NaN());
  std::vector<std::size_t> inside;
  for (std::size_t i = 0; i < out.size(); ++i)
    if (flow.outline().inside({x2[i % x2.size()], x3[i / x2.size()]})) inside.push_back(i);
  Net x(static_cast<Eigen::Index>(inside.size()), 3);
  for (Eigen::Index q = 0; q < x.rows(); ++q) {
    const std::size_t i = inside[static_cast<std::size_t>(q)];
    x.row(q) << 0, x2[i % x2.size()], x3[i / x2.size()];
  }
  const Net v = flow.velocities(x);
  for (Eigen::Index q = 0; q < x.rows(); ++q) out[inside[static_cast<std::size_t>(q)]] = v(q, 0);
  return out;
}

}  // namespace

std::vector<output::Array> duct_arrays(const stokes::DuctFlow& flow) {
  const auto [low, high] = flow.outline().box();
  const auto x2 = line(low[0], high[0]), x3 = line(low[1], high[1]), outline = outline_of(flow.outline());
  const auto [place, fastest] = flow.maximum();
  return {
      {"outline", "length", "points x2, x3 of the outline of the cross-section, a closed curve", outline, {outline.size() / 2, 2}},
      {"x2", "length", "coordinates x2 of the columns of the velocity grid", x2, {x2.size()}},
      {"x3", "length", "coordinates x3 of the rows of the velocity grid", x3, {x3.size()}},
      {"velocity", "length/time", "velocity along x1 in the empty tube, on the grid", velocities(flow, x2, x3), {x3.size(), x2.size()}},
      {"maximum",
       "length, length/time",
       "position x2, x3 of the largest velocity in the empty tube, and this velocity",
       {place[0], place[1], fastest},
       {3}},
      {"pressure_gradient", "pressure/length", "decrease of the pressure per length along the empty tube", {flow.pressure_gradient()}, {}},
      {"mean_velocity",
       "length/time",
       "mean velocity of the empty tube: flow rate divided by the area of the cross-section",
       {flow.mean_velocity()},
       {}},
      {"radius", "length", "radius R_T of the circle with the area of the cross-section", {flow.radius()}, {}}};
}

namespace {

constexpr int points_along = 301, sections = 10;

/// Returns the coordinates x1, x2, x3 of all points in one array, point after point.
std::vector<double> flat(const std::vector<Vec3>& rows) {
  std::vector<double> out;
  for (const Vec3& row : rows) out.insert(out.end(), row.data(), row.data() + 3);
  return out;
}

/// Data on the line along the channel's wall through the first point of the outline. s: arc length along the centre line. shear: magnitude of the
/// tangential traction.
struct WallLine {
  std::vector<double> s, shear, pressure;
};

WallLine along_wall(const coupling::ChannelFlow& flow) {
  const surface::TubeWall& wall = *flow.fixed_wall();
  WallLine line;
  for (int e = 0; e < static_cast<int>(wall.space.elements.size()); ++e)
    for (const double s : {0.125, 0.375, 0.625, 0.875}) {
      if (wall.space.elements[static_cast<std::size_t>(e)].origin[1] > 0) break;
      const spline::Site site{e, s, 0};
      const surface::Point at = surface::point(wall.space, wall.net, site);
      const Vec3 f = surface::value(wall.space, flow.wall_traction(), site);
      line.s.push_back(flow.channel().coordinates(at.x)[0]);
      line.shear.push_back((f - f.dot(at.n) * at.n).norm());
      line.pressure.push_back(-f.dot(at.n));
    }
  return line;
}

}  // namespace

std::vector<output::Array> described_channel_arrays() {
  return {{"s", "length", "arc length s along the centre line of the channel", {}, {}},
          {"centre", "length", "points of the centre line of the channel", {}, {}},
          {"factor", "1", "factors of the cross-section at s, along x2 (direction before a bend) and x3", {}, {}},
          {"wall", "length", "points of the wall at s: on both sides along x2 (direction before a bend), then on both sides along x3", {}, {}},
          {"velocity", "length/time", "velocity in the empty channel on the centre line", {}, {}},
          {"section_s", "length", "arc lengths of the cross-sections of `flow_rate`", {}, {}},
          {"flow_rate", "length^3/time", "flow rate of the empty channel through these cross-sections", {}, {}},
          {"pressure_drop", "force/length^2", "pressure drop between the ends of the empty channel", {}, {}},
          {"extra_pressure_drop", "force/length^2",
           "pressure drop of the empty channel minus that of a straight tube of the same length with the inlet's cross-section", {}, {}},
          {"wall_s", "length", "arc length along the line of the wall on which the outline begins", {}, {}},
          {"wall_shear_stress", "force/length^2", "magnitude of the tangential traction on this line in the empty channel", {}, {}},
          {"wall_pressure", "force/length^2", "pressure on this line in the empty channel, 0 at the outlet", {}, {}}};
}

std::vector<output::Array> channel_arrays(const coupling::ChannelFlow& flow) {
  const surface::Channel& channel = flow.channel();
  const auto [low, high] = channel.outline().box();
  std::vector<double> s, factor, rate_s;
  std::vector<Vec3> centre, lines[4];
  for (int k = 0; k < points_along; ++k) {
    s.push_back(channel.start() + (channel.end() - channel.start()) * k / (points_along - 1));
    const surface::Channel::Section at = channel.section(s.back());
    centre.push_back(at.centre);
    factor.insert(factor.end(), {at.factor[0], at.factor[1]});
    lines[0].push_back(at.centre + low[0] * at.factor[0] * at.normal), lines[1].push_back(at.centre + high[0] * at.factor[0] * at.normal);
    lines[2].push_back(at.centre + low[1] * at.factor[1] * Vec3::UnitZ()),
        lines[3].push_back(at.centre + high[1] * at.factor[1] * Vec3::UnitZ());
  }
  Net axis(points_along, 3);
  for (int k = 0; k < points_along; ++k) axis.row(k) = centre[static_cast<std::size_t>(k)].transpose();
  const Net v = flow.velocities(axis);
  std::vector<double> velocity(v.data(), v.data() + v.size());
  for (int k = 0; k < sections; ++k)
    rate_s.push_back(channel.start() + (channel.end() - channel.start()) * (0.2 + 0.6 * k / (sections - 1)));
  const std::vector<double> rate = flow.flow_rates_at(rate_s);
  const std::size_t n = s.size();
  std::vector<output::Array> all = described_channel_arrays();
  const auto set = [&all](const char* name, std::vector<double> values, std::vector<std::size_t> shape) {
    output::Array& one = *std::ranges::find(all, name, &output::Array::name);
    one.values = std::move(values), one.shape = std::move(shape);
  };
  std::vector<double> sides;
  for (const auto& side : lines)
    for (const double x : flat(side)) sides.push_back(x);
  set("s", s, {n}), set("centre", flat(centre), {n, 3}), set("factor", factor, {n, 2}), set("wall", sides, {4, n, 3});
  set("velocity", velocity, {n, 3}), set("section_s", rate_s, {rate_s.size()}), set("flow_rate", rate, {rate.size()});
  set("pressure_drop", {flow.pressure_drop()}, {}), set("extra_pressure_drop", {flow.extra_pressure_drop()}, {});
  if (!channel.repeats()) {
    const WallLine wall = along_wall(flow);
    const std::size_t m = wall.s.size();
    set("wall_s", wall.s, {m}), set("wall_shear_stress", wall.shear, {m}), set("wall_pressure", wall.pressure, {m});
  } else {  // the layer density on the wall of a periodic channel is not the traction
    std::erase_if(all, [](const output::Array& one) { return one.values.empty(); });
  }
  return all;
}

}  // namespace tanktread
