#include "system/solids/ducts/tube.hpp"

#include <stdexcept>

#include "system/solids/shared_walls.hpp"
#include "system/solids/ducts/tube_particle.hpp"

namespace tanktread::coupling {

Tube::Tube(const surface::TubeWall& wall, const stokes::DuctFlow& flow, const spline::Space& particle, const TubeParameters& parameters,
           Phases& phases)
    : phases_(phases) {
  const auto clock = phases_.time("wall assembly");
  duct_ = std::make_unique<Duct>(std::make_shared<stokes::DuctFlow>(flow),
                                 shared_wall(parameters.walls.get(), wall, parameters.quadrature, &phases_, surface::Symmetry(), {}),
                                 parameters.viscosity, parameters.holds_pressure_drop);
  particle_ = std::make_unique<ParticleData>(particle, parameters, *duct_, phases_);
}

Tube::Tube(std::shared_ptr<const ChannelFlow> flow, const spline::Space& particle, const TubeParameters& parameters, Phases& phases)
    : phases_(phases) {
  {
    const auto clock = phases_.time("wall assembly");
    duct_ = std::make_unique<Duct>(flow, flow->use_symmetry(phases_, parameters.symmetry), parameters.viscosity, parameters.holds_pressure_drop);
    flow->pressure_drop();
  }
  particle_ = std::make_unique<ParticleData>(particle, parameters, *duct_, phases_);
}

Tube::~Tube() = default;

const surface::TubeWall& Tube::wall() const { return duct_->wall().surface(); }
const stokes::DuctFlow& Tube::flow() const { return duct_->flow(); }
const std::optional<stokes::PeriodicCell>& Tube::cell() const { return duct_->wall().cell(); }
double Tube::frame_origin(const Net& x) const { return properties().fixed ? 0 : particle_->geometry.measures(x).centroid[0]; }
const Tube::InFlow& Tube::in_flow() const { return particle_->in_flow; }
LayerPair& Tube::particles() { return particle_->layers.value(); }

stokes::Evaluations Tube::kernel_evaluations() const {
  stokes::Evaluations all;
  if (particle_->layers) all += particle_->layers->evaluations();
  return particle_->parameters.walls ? all : all + duct_->wall().evaluations();
}

void Tube::set_particles(const Net& unstressed, std::span<const Particle> particles) {
  forget();
  particle_->set_particles(unstressed, particles);
}

void Tube::set_shape(const Net& x, std::optional<double> origin) {
  if (same(latest_shape_, x) && latest_origin_ == origin) return;
  if (!particle_->layers) throw std::logic_error("a tube needs its particles before their shape");
  const auto clock = phases_.time("wall");
  latest_shape_ = {}, latest_origin_ = origin;  // no shape is set if one of the next calls throws
  if (!origin && !properties().fixed) origin = frame_origin(x);
  if (!origin && cell()) origin = cell()->shift(x.colwise().mean().transpose() - (wall().start + wall().end) / 2 * Vec3::UnitX())[0];
  particle_->set_shape(x, origin.value_or(0));
  latest_shape_ = x;
}

double Tube::pressure_of(const Net& f) const { return dot(in_flow().weights_of_load, f); }

/// Returns the contribution of v to dp (2.7), 0 if lambda = 1. In a channel, it is the pressure drop for which the disturbance caused by v has zero
/// net flow rate. `on_wall`: velocity of this disturbance at the wall.
double Tube::pressure_of_velocity(const Net& v, const Net& on_wall) {
  if (v.size() == 0 || !particle_->has_double()) return 0;
  if (properties().parallel_flow) return dot(in_flow().weights_of_velocity, v);
  return duct_->disturbed_flow_rate().stopping_pressure_drop(on_wall, dot(particle_->flow_of_velocity(), v));
}

/// Adds the velocities that f and v cause at the wall and, by images, at the particle.
void Tube::add_caused(const Net& f, const Net& v, Response& to) {
  const ParticleData::Cause caused = particle_->cause(f, v);
  to.on_wall += duct_->wall().points().collocated(caused.at_wall);
  if (!cell()) return;
  to.velocity += particle_->ranks.filled(to.velocity.rows(), [&](Net& u) {
    for (const int i : particle_->sites.own) u.row(i) = caused.at_sites.row(i);
  });
}

Tube::Response Tube::cause(const Net& f, const Net& v, double pressure_correction) {
  if (latest_shape_.rows() == 0) throw std::logic_error("a tube needs the shape of the particles before it responds");
  Response found;
  found.velocity = Net::Zero(latest_shape_.rows(), 3), found.on_wall = Net::Zero(duct_->wall().points().sites().rows(), 3);
  if (v.size() > 0 && particle_->has_double()) add_caused({}, v, found);
  found.pressure_drop = pressure_of(f) + pressure_correction + pressure_of_velocity(v, found.on_wall);
  if (f.size() > 0) add_caused(f, {}, found);
  if (cell()) found.load = f, found.particle_velocity = v;
  return found;
}

void Tube::add_answer(Response& response) {
  response.velocity += particle_->ranks.filled(response.velocity.rows(), [&](Net& u) {
    duct_->wall().velocity(response.wall_traction, particle_->sites, u);
  }) / -duct_->viscosity();
  response.velocity += response.pressure_drop * in_flow().per_pressure_drop;
  if (const double slower = duct_->flow_rate_reduction(response.pressure_drop); slower != 0) response.velocity -= slower * in_flow().ambient;
}

Tube::Response Tube::respond(const Net& f, const Net& v, double pressure_correction) {
  const auto clock = phases_.time("wall");
  Response response = cause(f, v, pressure_correction);
  response.wall_traction = duct_->traction(response.on_wall, response.pressure_drop);
  add_answer(response);
  return response;
}

void Tube::velocity_at(const Eigen::SparseMatrix<double>& points, const Net& x, const Response& response, std::span<const int> rows, Net& u) {
  Net shape = x;
  shape.col(0).array() -= particle_->origin;  // before the product, so that a point at a far node equals this node up to round-off (node_sum)
  const PointsOff at{.at = points * shape, .own = {rows.begin(), rows.end()}, .first_image_row = 0};
  duct_->velocity(response.wall_traction, response.pressure_drop, at, u);
  if (cell()) particles().add(response.load, response.particle_velocity, at, u);
  if (const double slower = duct_->flow_rate_reduction(response.pressure_drop); slower != 0) {
    const Net ambient = flow().velocities(points * x);
    for (const int i : rows) u.row(i) -= slower * ambient.row(i);
  }
}

void Tube::freeze() {
  const auto clock = phases_.time("assembly");
  if (!duct_->wall().iterates()) particle_->freeze();
}

Net Tube::frozen_response(const Net& f, const Net& v) {
  const Ranks& ranks = particle_->ranks;
  const WallPoints& points = duct_->wall().points();
  const double viscosity = duct_->viscosity();
  const Eigen::Index n = particle_->shape.rows();
  if (duct_->wall().iterates()) return Net::Zero(n, 3);
  const ParticleData::Frozen& frozen = particle_->frozen;
  const double pressure = dot(frozen.in_flow.weights_of_load, f) + dot(frozen.in_flow.weights_of_velocity, v);
  const Net on_wall = points.ranks().filled(points.sites().rows(), [&](Net& u) { frozen.on_wall.add(f, v, viscosity, u); });
  const Net traction = duct_->traction(on_wall, pressure);
  const Net u = ranks.filled(n, [&](Net& own) {
    frozen.wall.apply(traction, own);
    own /= -viscosity;
    if (frozen.images) frozen.of_images.add(f, v, viscosity, own);
  });
  return u + pressure * frozen.in_flow.per_pressure_drop - duct_->flow_rate_reduction(pressure) * frozen.in_flow.ambient;
}

}  // namespace tanktread::coupling
