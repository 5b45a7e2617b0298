// Checks of the response of a tube by the conditions (2.14), and distance to the wall.

#include <algorithm>
#include <span>
#include <stdexcept>

#include "base/indices.hpp"
#include "surface/clearance.hpp"
#include "surface/closest_points.hpp"
#include "system/solids/ducts/tube_particle.hpp"

namespace tanktread::coupling {

namespace {

/// Adds points of a cross-section to `points`: points on straight lines from the centroid to the outline, if they are inside the outline. `place`:
/// maps points of the cross-section into space.
template <class Place>
void add_points_of_cap(const surface::Outline& outline, const Place& place, std::vector<Vec3>& points) {
  const surface::Vec2 centre = outline.centroid();
  for (int k = 0; k < outline.n_sides(); ++k)
    for (const double u : outline.knots(k, std::max(2, 12 / outline.n_sides())))
      for (const double share : {0.25, 0.5, 0.75, 0.9}) {
        const surface::Vec2 p = centre + share * (outline.point(k, u) - centre);
        if (outline.inside(p)) points.push_back(place(p));
      }
}

/// Returns points on the plane caps that close both ends of the tube.
std::vector<Vec3> points_of_caps(const surface::TubeWall& wall) {
  std::vector<Vec3> points;
  for (const double s : {wall.start, wall.end}) {
    switch (wall.kind) {
      case surface::DuctKind::straight_tube:
        add_points_of_cap(wall.outline, [&](const surface::Vec2& p) { return Vec3(s, p[0], p[1]); }, points);
        break;
      case surface::DuctKind::channel: {
        const surface::Channel::Section at = wall.channel->section(s);
        const auto place = [&](const surface::Vec2& p) -> Vec3 { return at.centre + p[0] * at.normal + p[1] * Vec3::UnitZ(); };
        add_points_of_cap(wall.channel->outline(s), place, points);
        break;
      }
    }
  }
  return points;
}

}  // namespace

Tube::Checks Tube::checks(const Net& f, const Net& v, const Response& response) {
  const double dp = response.pressure_drop, area = wall().outline.area(), flow = disturbed_flow_rate(f, v, response);
  const FlowRate& rate = duct_->disturbed_flow_rate();
  double force = (cell() ? 0 : area * dp) - rate.force(response.wall_traction);  // a periodic duct has no caps on which dp acts
  const stokes::Layer& layer = particles().single_layer;
  if (f.size() > 0) force -= layer.moments(layer.weights()).dot(f.col(0));
  const double force_of_pressure = area - rate.force(duct_->wall().traction_per_pressure_drop());

  Checks checks;
  checks.flux = flow / this->flow().flow_rate();
  checks.force = force / (area * this->flow().pressure_gradient() * this->flow().radius());
  if (!cell()) checks.cap_velocity = cap_velocity(f, v, response) / this->flow().mean_velocity();
  checks.pressure_by_flux = dp - flow / rate.per_pressure_drop();
  checks.pressure_by_force = dp - force / force_of_pressure;
  return checks;
}

double Tube::cap_velocity(const Net& f, const Net& v, const Response& response) {
  const std::vector<Vec3> points = points_of_caps(wall());
  const PointsOff at{.at = Eigen::Map<const Net>(points.front().data(), static_cast<Eigen::Index>(points.size()), 3),
                     .own = indices(points.size())};
  Net u(at.at.rows(), 3);
  duct_->velocity(response.wall_traction, response.pressure_drop, at, u);
  particles().add(f, v, at, u);
  return u.rowwise().norm().maxCoeff();
}

double Tube::disturbed_flow_rate(const Net& f, const Net& v, const Response& response) {
  const FlowRate& rate = duct_->disturbed_flow_rate();
  double flow = rate.of_answer(response.wall_traction, response.pressure_drop);
  if (f.size() > 0) flow += rate.of_load(f, particles());
  if (v.size() > 0 && particle_->has_double()) flow += dot(particle_->flow_of_velocity(), v);
  return flow;
}

double Tube::gap() const {
  switch (wall().kind) {
    case surface::DuctKind::straight_tube:
      return surface::clearance(surface::Patches(particle_->geometry.bezier(), particle_->shape), wall().outline).gap;
    case surface::DuctKind::channel: return gap_to_channel_wall();
  }
  throw std::logic_error("unknown DuctKind");
}

/// Returns the gap to the wall of a channel, from the closest points of the two surfaces. Of elements that are images of each other, searches one.
double Tube::gap_to_channel_wall() const {
  const auto points = [&](int e) -> std::span<const int> { return particle_->space.elements[static_cast<std::size_t>(e)].points; };
  const std::vector<int> elements =
      surface::fundamental_elements(particle_->parameters.symmetry, static_cast<int>(particle_->space.elements.size()), points).element;
  const double radius = wall().radius();
  Wall& around = duct_->wall();
  const double nearest =
      surface::gap_to_wall(particle_->geometry.bezier(), particle_->shape, elements, around.boxes(), wall().period, 1e-5 * radius, radius);
  return around.first_outside(particle_->sites.at, indices(particle_->sites.at.rows())) < 0 ? nearest : -nearest;
}

}  // namespace tanktread::coupling
