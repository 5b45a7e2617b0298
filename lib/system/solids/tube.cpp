#include "system/solids/tube.hpp"

#include "system/collocation.hpp"
#include "system/solids/tube_particle.hpp"

namespace tanktread::coupling {

Tube::Tube(const surface::TubeWall& wall, const stokes::DuctFlow& flow, const spline::Space& particle, const TubeParameters& parameters,
           Phases& phases)
    : flow_(std::make_shared<stokes::DuctFlow>(flow)), phases_(phases) {
  const auto clock = phases_.time("wall assembly");
  wall_ = std::make_shared<Wall>(wall, parameters.quadrature, &phases_);
  particle_ = std::make_unique<Particle>(particle, parameters);
  particle_->ranks.measure(phases_);
}

Tube::Tube(std::shared_ptr<const ChannelFlow> flow, const spline::Space& particle, const TubeParameters& parameters, Phases& phases)
    : flow_(flow), phases_(phases) {
  {
    const auto clock = phases_.time("wall assembly");
    wall_ = flow->wall(phases_, parameters.symmetry);
    flow->pressure_drop();
  }
  particle_ = std::make_unique<Particle>(particle, parameters);
  particle_->ranks.measure(phases_);
}

Tube::Tube(const Tube& tube, const spline::Space& particle) : flow_(tube.flow_), phases_(tube.phases_), wall_(tube.wall_) {
  particle_ = std::make_unique<Particle>(particle, tube.particle_->parameters);
  particle_->ranks.measure(phases_);
}

Tube::~Tube() = default;

const surface::TubeWall& Tube::wall() const { return wall_->surface(); }
const Net& Tube::inlet_on_particle() const { return particle_->inlet; }
const Net& Tube::ambient() const { return particle_->ambient; }
int Tube::copies() const { return 1 + static_cast<int>(particle_->shifts.size()); }

stokes::Evaluations Tube::kernel_evaluations() const {
  return wall_->evaluations() + particle_->evaluations();
}

void Tube::set_contrasts(const Eigen::VectorXd& contrasts) { particle_->set_contrasts(contrasts); }

void Tube::set_reference(const Net& unstressed, stokes::Measure measure, std::vector<bool> present) {
  particle_->single.set_reference(unstressed, std::move(present));
  particle_->measure = measure;
}

Net Tube::in_wall_frame(Net x) const {
  if (!fixed()) x.col(0).array() -= particle_->geometry.measures(x).centroid[0];
  return x;
}

void Tube::place(const Net& x) {
  const auto clock = phases_.time("wall");
  particle_->place(x, *flow_, *wall_);
}

double Tube::pressure_of(const Net& f, const Net& v) {
  const bool by_flow = fixed() && particle_->dual && v.size() > 0;
  return dot(particle_->pressure_of_load, f) + (by_flow ? pressure_of_velocity(v, velocity_on_wall(v)) : dot(particle_->pressure_of_velocity, v));
}

/// dp with which the flow rate of the disturbance that v makes vanishes; `on_wall`: its velocity there.
double Tube::pressure_of_velocity(const Net& v, const Net& on_wall) {
  weigh_flow();
  const double taken_away = wall_->iterates() ? dot(flow_weights_, wall_->solve(on_wall)) : dot(flow_of_wall_, on_wall);
  return (taken_away - dot(particle_->flow_of_strength(wall_->inlet()), particle_->strength(v))) / flow_of_pressure_;
}

double Tube::lacking_pressure(const BetweenSites& between, const Net& at_places, double amplitude, const Net& f, double work) {
  if (fixed()) work += dot(between.weights * (at_places - amplitude * (between.values * particle_->interpolated_ambient)), f);
  return -copies() * work / (amplitude * flow_->flow_rate());
}

Net Tube::load_on_wall(const Net& f) {
  Net u(wall_->targets().rows(), 3);
  particle_->single.apply(f, wall_->targets(), wall_->own_targets(), u);
  particle_->add_copies(particle_->single, f, wall_->targets(), wall_->own_targets(), u);
  return wall_->collocated(u) / -viscosity();
}

Net Tube::velocity_on_wall(const Net& v) {
  if (!particle_->dual) return Net::Zero(wall_->sites().rows(), 3);
  const Net strength = particle_->strength(v), &targets = wall_->targets();
  Net u(targets.rows(), 3);
  particle_->dual->apply(strength, particle_->nearest_values(strength), targets, wall_->own_targets(), u, particle_->kept(particle_->dual_on_wall));
  particle_->add_copies(*particle_->dual, strength, targets, wall_->own_targets(), u);
  return wall_->collocated(u);
}

Net Tube::wall_on_particle(const Net& traction) {
  Net u(particle_->sites.rows(), 3);
  wall_->layer().apply(traction, particle_->sites, particle_->own, u, particle_->kept(particle_->wall_on_sites));
  particle_->ranks.replicate(u);
  return -u / viscosity();
}

Net Tube::copies_on_particle(const Net& f, const Net& v) {
  Net u = Net::Zero(particle_->sites.rows(), 3);
  if (f.size() > 0) particle_->add_copies(particle_->single, -f / viscosity(), particle_->sites, particle_->own, u);
  if (v.size() > 0 && particle_->dual) particle_->add_copies(*particle_->dual, particle_->strength(v), particle_->sites, particle_->own, u);
  particle_->ranks.replicate(u);
  return u;
}

Net Tube::wall_on_wall(const Net& traction) { return wall_->apply(traction) / viscosity(); }

Net Tube::inlet_on_wall() const { return wall_->inlet_column() / viscosity(); }

Net Tube::solve_wall(const Net& rhs) { return viscosity() * wall_->solve(rhs); }

double Tube::viscosity() const { return particle_->parameters.viscosity; }

Tube::Response Tube::respond(const Net& f, const Net& v, double lacking) {
  const auto clock = phases_.time("wall");
  Response response;
  response.pressure_drop = pressure_of(f) + lacking;
  Net on_wall = Net::Zero(wall_->sites().rows(), 3);
  if (v.size() > 0 && particle_->dual) {
    on_wall += velocity_on_wall(v);
    response.pressure_drop += fixed() ? pressure_of_velocity(v, on_wall) : dot(particle_->pressure_of_velocity, v);
  }
  if (f.size() > 0) on_wall += load_on_wall(f);
  response.wall_traction = solve_wall(on_wall) + response.pressure_drop * wall_->pumped();
  response.velocity = wall_on_particle(response.wall_traction) + response.pressure_drop * particle_->inlet;
  if (copies() > 1) response.velocity += copies_on_particle(f, v), response.load = f, response.moves = v;
  if (const double slower = slowed(response.pressure_drop); slower != 0) response.velocity -= slower * particle_->ambient;
  return response;
}

/// By what part of it the flow is slower where its pressure drop is held.
double Tube::slowed(double pressure_drop) const {
  if (!particle_->parameters.holds_pressure_drop) return 0;
  const auto* channel = dynamic_cast<const ChannelFlow*>(flow_.get());
  const double length = copies() > 1 ? copies() * particle_->parameters.period : wall().length();
  return pressure_drop / (channel ? channel->pressure_drop() : flow_->pressure_gradient() * length);
}

void Tube::velocity_at(const Net& x, const Response& response, std::span<const int> rows, Net& u) {
  Net at = x;
  at.col(0).array() -= particle_->centroid;
  wall_->layer().apply(response.wall_traction, at, rows, u);
  for (const int i : rows) u.row(i) = (response.pressure_drop * wall_->inlet().integral(Net(at.row(i))).row(0) - u.row(i)) / viscosity();
  if (response.load.size() > 0) particle_->add_copies(particle_->single, -response.load / viscosity(), at, rows, u);
  if (response.moves.size() > 0 && particle_->dual) particle_->add_copies(*particle_->dual, particle_->strength(response.moves), at, rows, u);
  if (const double slower = slowed(response.pressure_drop); slower != 0) {
    const Net ambient = flow_->velocities(x);
    for (const int i : rows) u.row(i) -= slower * ambient.row(i);
  }
}

void Tube::freeze() {
  const auto clock = phases_.time("assembly");
  if (wall_->iterates()) return;
  const bool by_flow = fixed() && particle_->dual;
  if (by_flow) weigh_flow();
  particle_->freeze(*wall_, by_flow ? Net(flow_of_wall_ / flow_of_pressure_) : Net());
  if (!by_flow) return;
  const Net& through_inlet = particle_->flow_of_strength(wall_->inlet());
  particle_->frozen.pressure_of_velocity -= particle_->contrasts.asDiagonal() * through_inlet / flow_of_pressure_;
}

Net Tube::frozen_response(const Net& f, const Net& v) {
  if (wall_->iterates()) return Net::Zero(particle_->sites.rows(), 3);
  const Particle::Frozen& frozen = particle_->frozen;
  const double pressure = dot(frozen.pressure_of_load, f) + dot(frozen.pressure_of_velocity, v);
  Net on_wall = Net::Zero(wall_->sites().rows(), 3), part = on_wall;
  if (f.size() > 0) {
    frozen.single.apply(f, part);
    on_wall -= part / viscosity();
  }
  if (v.size() > 0 && particle_->dual) {
    frozen.dual.apply(particle_->strength(v), part);
    on_wall += part;
  }
  wall_->ranks().replicate(on_wall);
  Net u(particle_->sites.rows(), 3);
  frozen.wall.apply(solve_wall(on_wall) + pressure * wall_->pumped(), u);
  if (copies() > 1) {
    part = Net::Zero(u.rows(), 3);
    if (f.size() > 0) frozen.single_of_copies.apply(f, part), u += part;
    if (v.size() > 0 && particle_->dual) frozen.dual_of_copies.apply(particle_->strength(v), part), u -= viscosity() * part;
  }
  particle_->ranks.replicate(u);
  return -u / viscosity() + pressure * frozen.inlet - slowed(pressure) * frozen.ambient;
}

}  // namespace tanktread::coupling
