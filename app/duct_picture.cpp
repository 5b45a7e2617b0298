#include "app/duct_picture.hpp"

#include <cmath>
#include <limits>

namespace tanktread {
namespace {

constexpr int places_around = 400, lines = 121;

std::vector<double> outline_of(const surface::Outline& outline) {
  std::vector<double> out;
  const auto share = outline.shares(places_around);
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

/// One call for all the points inside.
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

std::vector<output::Array> duct_picture(const stokes::DuctFlow& flow) {
  const auto [low, high] = flow.outline().box();
  const auto x2 = line(low[0], high[0]), x3 = line(low[1], high[1]), outline = outline_of(flow.outline());
  const auto [place, fastest] = flow.maximum();
  return {{"outline", "length", "places x2, x3 on the wall, closed", outline, {outline.size() / 2, 2}},
          {"x2", "length", "columns of the grid", x2, {x2.size()}},
          {"x3", "length", "rows of the grid", x3, {x3.size()}},
          {"velocity", "length/time", "along x1 in the empty tube", velocities(flow, x2, x3), {x3.size(), x2.size()}},
          {"maximum", "length, length/time", "place x2, x3 of the largest velocity, and this velocity", {place[0], place[1], fastest}, {3}},
          {"pressure_gradient", "pressure/length", "fall of the pressure along the empty tube", {flow.pressure_gradient()}, {}},
          {"mean_velocity", "length/time", "flow rate over area", {flow.mean_velocity()}, {}},
          {"radius", "length", "R_T: of the circle of equal area", {flow.radius()}, {}}};
}

}  // namespace tanktread
