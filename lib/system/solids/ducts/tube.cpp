#include "system/solids/ducts/tube.hpp"

#include <stdexcept>

#include "system/targets/collocation.hpp"
#include "system/solids/shared_walls.hpp"
#include "system/solids/ducts/tube_particle.hpp"

namespace tanktread::coupling {

Tube::Tube(const surface::TubeWall& wall, const stokes::DuctFlow& flow, const spline::Space& particle, const TubeParameters& parameters,
           Phases& phases)
    : flow_(std::make_shared<stokes::DuctFlow>(flow)), phases_(phases) {
  const auto clock = phases_.time("wall assembly");
  wall_ = shared_wall(parameters.walls.get(), wall, parameters.quadrature, &phases_, surface::Symmetry(), {});
  particle_ = std::make_unique<ParticleData>(particle, parameters, *wall_, phases_);
  inner_radius_ = wall.outline.distance(wall.outline.centroid());
}

Tube::Tube(std::shared_ptr<const ChannelFlow> flow, const spline::Space& particle, const TubeParameters& parameters, Phases& phases)
    : flow_(flow), phases_(phases) {
  {
    const auto clock = phases_.time("wall assembly");
    wall_ = flow->use_symmetry(phases_, parameters.symmetry);
    flow->pressure_drop();
  }
  particle_ = std::make_unique<ParticleData>(particle, parameters, *wall_, phases_);
}

Tube::~Tube() = default;

const surface::TubeWall& Tube::wall() const { return wall_->surface(); }

void Tube::set_particles(const Net& unstressed, std::span<const Particle> particles) {
  particle_->set_particles(unstressed, particles, *wall_);
  latest_shape_ = {};
}

const Net& Tube::ambient() const { return particle_->ambient; }
const std::optional<stokes::PeriodicCell>& Tube::cell() const { return wall_->cell(); }

stokes::Evaluations Tube::kernel_evaluations() const {
  stokes::Evaluations all;
  if (particle_->layers) all += particle_->layers->evaluations();
  if (!particle_->parameters.walls) all += wall_->evaluations();
  return between_ ? all + between_->layer.evaluations() : all;
}

double Tube::frame_origin(const Net& x) const { return fixed() ? 0 : particle_->geometry.measures(x).centroid[0]; }

void Tube::set_shape(const Net& x, std::optional<double> origin) {
  if (same(latest_shape_, x) && latest_origin_ == origin) return;
  const auto clock = phases_.time("wall");
  if (!particle_->layers) throw std::logic_error("a tube needs its particles before their shape");
  latest_shape_ = {}, latest_origin_ = origin;  // no shape is set if one of the next calls throws
  if (!origin && !fixed()) origin = particle_->geometry.measures(x).centroid[0];
  if (!origin && cell()) origin = cell()->shift(x.colwise().mean().transpose() - (wall().start + wall().end) / 2 * Vec3::UnitX())[0];
  particle_->set_shape(x, origin.value_or(0), *flow_, *wall_, empty_pressure_drop());
  latest_shape_ = x;
}

double Tube::pressure_of(const Net& f, const Net& v) {
  return dot(particle_->weights_of_load, f) + pressure_of_velocity(v);
}

/// Returns the contribution of v to dp (2.7), 0 if lambda = 1. In a channel, it is the pressure drop for which the disturbance caused by v has zero
/// net flow rate. `on_wall`: velocity of this disturbance at the wall; if null, it is computed when needed.
double Tube::pressure_of_velocity(const Net& v, const Net* on_wall) {
  if (v.size() == 0 || !particle_->has_double()) return 0;
  if (properties().parallel_flow) return dot(particle_->weights_of_velocity, v);
  if (!on_wall) {
    const Net caused = particle_on_wall({}, v);
    return pressure_of_velocity(v, &caused);
  }
  const FlowWeights& weights = flow_weights();
  const double taken_away = wall_->iterates() ? dot(weights.of_traction, wall_->solve(*on_wall)) : dot(weights.of_velocity, *on_wall);
  return (taken_away - dot(particle_->flow_of_velocity(*wall_), v)) / weights.of_pressure;
}

double Tube::ambient_correction(const BetweenSites& between, const Net& at_places, const Net& f) const {
  if (properties().parallel_flow) return 0;
  return -dot(between.weights * (at_places - between.values * particle_->interpolated_ambient), f) / flow_->flow_rate();
}

double Tube::pressure_correction(const BetweenSites& between, const Net& at_places, const Net& f, double work) const {
  return ambient_correction(between, at_places, f) - work / flow_->flow_rate();
}

Net Tube::particle_on_wall(const Net& f, const Net& v) { return wall_->points().collocated(particle_->cause(f, v).at_wall); }

Net Tube::wall_on_particle(const Net& traction) {
  const auto& near = particle_->wall_on_sites;
  return particle_->ranks.filled(particle_->sites.rows(), [&](Net& u) {
    wall_->layer().apply(wall_->on_space(traction), particle_->sites, particle_->own, u, near ? &*near : nullptr);
  }) / -viscosity();
}

/// Returns, on all ranks, a net with one row per collocation point of the particle, gathered from the rank-owned rows of `own`.
Net Tube::on_particle(const Net& own) const {
  return particle_->ranks.filled(own.rows(), [&](Net& u) {
    for (const int i : particle_->own) u.row(i) = own.row(i);
  });
}

Net Tube::wall_on_wall(const Net& traction) { return wall_->apply(traction) / viscosity(); }

Net Tube::inlet_on_wall() const { return wall_->inlet_column() / viscosity(); }

Net Tube::solve_wall(const Net& rhs) { return viscosity() * wall_->solve(rhs); }

double Tube::viscosity() const { return particle_->parameters.viscosity; }

Tube::Response Tube::cause(const Net& f, const Net& v, double pressure_correction) {
  if (latest_shape_.rows() == 0) throw std::logic_error("a tube needs the shape of the particles before it responds");
  Response found;
  found.pressure_drop = pressure_of(f) + pressure_correction;
  if (cell()) {
    ParticleData::Cause both = particle_->cause(f, v);
    found.on_wall = wall_->points().collocated(both.at_wall);
    found.pressure_drop += pressure_of_velocity(v, f.size() > 0 ? nullptr : &found.on_wall);
    found.velocity = on_particle(std::move(both.at_sites));
    found.load = f, found.particle_velocity = v;
    return found;
  }
  found.velocity = Net::Zero(particle_->sites.rows(), 3), found.on_wall = Net::Zero(wall_->points().sites().rows(), 3);
  if (v.size() > 0 && particle_->has_double()) found.on_wall += particle_on_wall({}, v);
  found.pressure_drop += pressure_of_velocity(v, &found.on_wall);
  if (f.size() > 0) found.on_wall += particle_on_wall(f);
  return found;
}

void Tube::add_answer(Response& response) {
  response.velocity = response.velocity + wall_on_particle(response.wall_traction) + response.pressure_drop * particle_->inlet;
  if (const double slower = flow_rate_reduction(response.pressure_drop); slower != 0) response.velocity -= slower * particle_->ambient;
}

Tube::Response Tube::respond(const Net& f, const Net& v, double pressure_correction) {
  const auto clock = phases_.time("wall");
  Response response = cause(f, v, pressure_correction);
  response.wall_traction = solve_wall(response.on_wall) + response.pressure_drop * wall_->traction_per_pressure_drop();
  add_answer(response);
  return response;
}

/// Returns the pressure drop of the empty duct over the modelled length, or over one period.
double Tube::empty_pressure_drop() const { return flow_->pressure_drop(wall().length()); }

double Tube::flow_rate_reduction(double pressure_drop) const {
  return particle_->parameters.holds_pressure_drop ? pressure_drop / empty_pressure_drop() : 0;
}

/// Returns mu c (2.5) at points in the wall's frame: mu times the velocity due to a unit pressure drop, without the velocity due to the wall's
/// traction.
Net Tube::pressure_driven_velocity(const Net& at) const {
  return cell() ? Net(viscosity() / empty_pressure_drop() * flow_->velocities(at)) : wall_->inlet().integral(at);
}

void Tube::velocity_at(const Eigen::SparseMatrix<double>& points, const Net& x, const Response& response, std::span<const int> rows, Net& u) {
  Net shape = x;
  shape.col(0).array() -= particle_->origin;  // before the product, so that a point at a far node equals this node up to round-off (node_sum)
  const Net at = points * shape;
  wall_->layer().apply(wall_->on_space(response.wall_traction), at, rows, u);
  const Net by_pressure = cell() ? Net(pressure_driven_velocity(at)(rows, Eigen::all)) : pressure_driven_velocity(at(rows, Eigen::all));
  for (std::size_t k = 0; k < rows.size(); ++k)
    u.row(rows[k]) = (response.pressure_drop * by_pressure.row(static_cast<Eigen::Index>(k)) - u.row(rows[k])) / viscosity();
  const PointsOff images{.at = at, .own = {rows.begin(), rows.end()}, .first_image_row = 0};
  if (cell()) particle_->layers->add(response.load, response.particle_velocity, images, u);
  if (const double slower = flow_rate_reduction(response.pressure_drop); slower != 0) {
    const Net ambient = flow_->velocities(points * x);
    for (const int i : rows) u.row(i) -= slower * ambient.row(i);
  }
}

void Tube::freeze() {
  const auto clock = phases_.time("assembly");
  if (wall_->iterates()) return;
  const bool by_flow = !properties().parallel_flow && particle_->has_double();
  particle_->freeze(*wall_, by_flow ? Net(flow_weights().of_velocity / flow_weights().of_pressure) : Net());
  if (by_flow) particle_->frozen.weights_of_velocity -= particle_->flow_of_velocity(*wall_) / flow_weights().of_pressure;
}

Net Tube::frozen_response(const Net& f, const Net& v) {
  if (wall_->iterates()) return Net::Zero(particle_->sites.rows(), 3);
  const ParticleData::Frozen& frozen = particle_->frozen;
  const double pressure = dot(frozen.weights_of_load, f) + dot(frozen.weights_of_velocity, v);
  const auto add = [](double factor, const FrozenOperator& of, const Net& strength, Net& to) {
    Net part = Net::Zero(to.rows(), 3);
    of.apply(strength, part);
    to += factor * part;
  };
  const bool has_velocity = v.size() > 0 && particle_->has_double();
  const auto add_layers = [&](const FrozenOperator& single, const FrozenOperator& dual, Net& u) {
    if (f.size() > 0) add(-1 / viscosity(), single, f, u);
    if (has_velocity) add(1, dual, v, u);
  };
  const Net on_wall = wall_->points().ranks().filled(wall_->points().sites().rows(), [&](Net& u) { add_layers(frozen.single, frozen.dual, u); });
  const Net traction = solve_wall(on_wall) + pressure * wall_->traction_per_pressure_drop();
  const Net u = particle_->ranks.filled(particle_->sites.rows(), [&](Net& own) {
    add(-1 / viscosity(), frozen.wall, traction, own);
    if (frozen.images) add_layers(frozen.single_of_images, frozen.dual_of_images, own);
  });
  return u + pressure * frozen.inlet - flow_rate_reduction(pressure) * frozen.ambient;
}

}  // namespace tanktread::coupling
