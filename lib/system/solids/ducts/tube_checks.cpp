// Checks of the response of a tube by the conditions (2.14).

#include <algorithm>
#include <span>

#include "base/indices.hpp"
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

/// Returns the errors of the response in the conditions (2.14).
Tube::Checks Tube::checks(const Net& f, const Net& v, const Response& response) {
  const double dp = response.pressure_drop, area = wall_->surface().outline.area(), flow = flow_rate_of(f, v, response);
  const FlowWeights& weights = flow_weights();
  double force = (cell() ? 0 : area * dp) - dot(weights.force, response.wall_traction);  // a periodic duct has no caps on which dp acts
  const stokes::Layer& layer = particle_->sources.single_layer;
  if (f.size() > 0) force -= layer.moments(layer.weights()).dot(f.col(0));
  const double force_of_pressure = area - dot(weights.force, wall_->traction_per_pressure_drop());

  Checks checks;
  checks.flux = flow / flow_->flow_rate();
  checks.force = force / (area * flow_->pressure_gradient() * flow_->radius());
  if (!cell()) checks.cap_velocity = cap_velocity(f, v, response) / flow_->mean_velocity();
  checks.pressure_by_flux = dp - flow / weights.of_pressure;
  checks.pressure_by_force = dp - force / force_of_pressure;
  return checks;
}

double Tube::cap_velocity(const Net& f, const Net& v, const Response& response) {
  const double mu = viscosity();
  const std::vector<Vec3> points = points_of_caps(wall_->surface());
  const Net at = Eigen::Map<const Net>(points.front().data(), static_cast<Eigen::Index>(points.size()), 3);
  Net part = at;
  const std::vector<int> all = indices(at.rows());
  Net u = response.pressure_drop / mu * wall_->inlet().integral(at);
  wall_->layer().apply(wall_->on_space(response.wall_traction), at, all, part);
  u -= part / mu;
  particle_->sources.add_velocity(f, v, at, all, u);
  return u.rowwise().norm().maxCoeff();
}

}  // namespace tanktread::coupling
