// Flow rate that a response of a tube causes, and the residual velocity on its wall, for corrections of collocation errors (2.42).

#include <algorithm>
#include <span>

#include "system/solids/ducts/tube_particle.hpp"
#include "system/targets/collocation.hpp"

namespace tanktread::coupling {

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
    stokes::Layer& layer = particle.sources.single_layer;
    std::vector<double> value[3];
    layer.values(f, value);
    const auto& node = layer.nodes();
    for (std::size_t k = 0; k < value[0].size(); ++k) {
      const Net at = (Net(1, 3) << node[0][k], node[1][k], node[2][k]).finished();
      flow -= layer.weights()[k] * wall_->flow_of_forces(at).row(0).dot(Vec3(value[0][k], value[1][k], value[2][k])) / viscosity();
    }
  }
  if (v.size() > 0 && particle.sources.has_double()) flow += dot(particle.flow_of_strength(*wall_), particle.sources.strength(v));
  return flow;
}

namespace {

constexpr double sharpness = 1e-2, coarsest = 1e-8;  // sharpness: factor by which wall_residual() multiplies the tolerance of integrals over the
                                                     // wall, because pressures are large. coarsest: upper limit of this product

quadrature::Options for_wall_residual(quadrature::Options options) {
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
    particle_->sources.add_velocity(f, {}, at, own, velocity);
  });
  return {wall_->from_space(Net(between_->weights * u)), flow_rate_of(f, {}, response)};
}

double Tube::work(const WallResidual& residual, const Response& of) const {
  return dot(of.wall_traction, residual.velocity) - of.pressure_drop * residual.flow;
}

}  // namespace tanktread::coupling
