// Checks of the response of a tube by the conditions (2.14), flow rate and residual velocity that it causes (2.42), and distance to the wall.

#include <algorithm>
#include <limits>
#include <span>
#include <stdexcept>

#include "base/indices.hpp"
#include "surface/clearance.hpp"
#include "surface/closest_points.hpp"
#include "system/solids/ducts/tube_particle.hpp"
#include "system/targets/collocation.hpp"

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
  const stokes::Layer& layer = particle_->layers->single_layer;
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
  particle_->layers->add(f, v, {.at = at, .own = all}, u);
  return u.rowwise().norm().maxCoeff();
}

const Tube::FlowWeights& Tube::flow_weights() {
  if (flow_weights_) return *flow_weights_;
  FlowWeights& found = flow_weights_.emplace();
  found.of_traction = wall_->flow_weights();
  found.force = wall_->force_weights();
  if (!wall_->iterates()) found.of_velocity = wall_->solve_transposed(found.of_traction);
  found.own = cell() ? viscosity() * flow_->flow_rate() / empty_pressure_drop() : wall_->inlet().own_flow();
  found.of_pressure = (found.own - dot(found.of_traction, wall_->traction_per_pressure_drop())) / viscosity();
  return found;
}

/// Returns the flow rate of the disturbance through the inlet. By reciprocity, a force f at y causes the flow rate f.c(y)/mu, with c of (2.13).
/// Therefore no quadrature over the inlet is needed.
double Tube::flow_rate_of(const Net& f, const Net& v, const Response& response) {
  ParticleData& particle = *particle_;
  const FlowWeights& weights = flow_weights();
  double flow = (response.pressure_drop * weights.own - dot(weights.of_traction, response.wall_traction)) / viscosity();
  if (f.size() > 0) {
    stokes::Layer& layer = particle.layers->single_layer;
    std::vector<double> value[3];
    layer.values(f, value);
    const auto& node = layer.nodes();
    for (std::size_t k = 0; k < value[0].size(); ++k) {
      const Net at = (Net(1, 3) << node[0][k], node[1][k], node[2][k]).finished();
      flow -= layer.weights()[k] * wall_->flow_of_forces(at).row(0).dot(Vec3(value[0][k], value[1][k], value[2][k])) / viscosity();
    }
  }
  if (v.size() > 0 && particle.has_double()) flow += dot(particle.flow_of_velocity(*wall_), v);
  return flow;
}

namespace {

quadrature::Options for_wall_residual(quadrature::Options options) {
  constexpr double sharpness = 1e-2, coarsest = 1e-8;  // sharpness: factor by which wall_residual() multiplies the tolerance of integrals over the
                                                       // wall, because pressures are large. coarsest: upper limit of this product
  options.tolerance = std::clamp(sharpness * options.tolerance, 1e-12, coarsest);
  return options;
}

}  // namespace

Tube::BetweenSitesOfWall::BetweenSitesOfWall(const surface::TubeWall& wall, const std::optional<stokes::PeriodicCell>& cell,
                                             const BetweenSites& between, const quadrature::Options& options)
    : at(between.values * wall.net),
      weights(between.weights),
      layer(stokes::Layer::Kernel::single_layer, wall.space, between.sites, for_wall_residual(options)) {
  if (cell) layer.repeat(*cell);
  layer.set_shape(wall.net);
}

Tube::WallResidual Tube::wall_residual(const Net& f) {
  const Response response = respond(f);
  const surface::TubeWall& wall = wall_->surface();
  if (!between_)
    between_ = std::make_unique<BetweenSitesOfWall>(wall, cell(), between_sites(wall.space, wall.net), particle_->parameters.quadrature);
  const Net &at = between_->at, by_pressure = response.pressure_drop * pressure_driven_velocity(at);
  const Net u = wall_->points().ranks().divided<Net>(static_cast<int>(at.rows()), 3, [&](std::span<const int> own, Net& velocity) {
    Net of_wall(at.rows(), 3);
    between_->layer.apply(wall_->on_space(response.wall_traction), own, of_wall);
    for (const int i : own) velocity.row(i) = (by_pressure.row(i) - of_wall.row(i)) / viscosity();
    particle_->layers->add(f, {}, {.at = at, .own = {own.begin(), own.end()}}, velocity);
  });
  return {wall_->from_space(Net(between_->weights * u)), flow_rate_of(f, {}, response)};
}

double Tube::work(const WallResidual& residual, const Response& of) const {
  return dot(of.wall_traction, residual.velocity) - of.pressure_drop * residual.flow;
}

Eigen::Index Tube::first_outside(const Net& x, std::span<const int> rows) const {
  const surface::TubeWall& wall = wall_->surface();
  const auto first = std::ranges::find_if_not(rows, [&](int i) {
    const Vec3 place = x.row(i).transpose();
    switch (wall.kind) {
      case surface::DuctKind::straight_tube:
        return (place.tail<2>() - wall.outline.centroid()).norm() < inner_radius_ || wall.outline.inside(place.tail<2>());
      case surface::DuctKind::channel: return wall.channel->inside(place);
    }
    throw std::logic_error("unknown DuctKind");
  });
  return first == rows.end() ? -1 : *first;
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
  const double radius = wall().radius(), nearest = surface::gap_to_wall(particle_->geometry.bezier(), particle_->shape, elements, wall_->boxes(),
                                                                        wall().period, 1e-5 * radius, radius);
  return first_outside(particle_->sites, indices(particle_->sites.rows())) < 0 ? nearest : -nearest;
}

}  // namespace tanktread::coupling
