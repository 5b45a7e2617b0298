#include "system/solids/ducts/tube_particle.hpp"

#include <span>
#include <utility>
#include <vector>

#include "system/targets/collocation.hpp"

namespace tanktread::coupling {

using stokes::Layer;

namespace {

Net as_net(const std::vector<double> (&columns)[3]) {
  Net net(static_cast<Eigen::Index>(columns[0].size()), 3);
  for (int c = 0; c < 3; ++c) net.col(c) = Eigen::Map<const Eigen::VectorXd>(columns[c].data(), net.rows());
  return net;
}

void set_columns(const Net& net, std::vector<double> (&columns)[3]) {
  for (int c = 0; c < 3; ++c) {
    columns[c].resize(static_cast<std::size_t>(net.rows()));
    Eigen::Map<Eigen::VectorXd>(columns[c].data(), net.rows()) = net.col(c);
  }
}

}  // namespace

Tube::ParticleData::ParticleData(const spline::Space& particle, const TubeParameters& how, const Wall& wall, Phases& phases)
    : space(particle),
      parameters(how),
      geometry(particle),
      collocation(collocation_matrix(particle)),
      from_sites(how.direct),
      periodic(wall.cell()) {
  own = ranks.divide_points(space, parameters.symmetry.order() > 1 ? parameters.symmetry : surface::Symmetry(space.n_points));
  from_sites.factor(collocation);
  ranks.measure(phases);
}

void Tube::ParticleData::set_particles(const Net& unstressed, std::span<const Particle> particles, const Wall& wall) {
  layers.emplace(space, stokes::Sites(), unstressed, particles, parameters.quadrature, parameters.viscosity);
  if (wall.cell()) layers->repeat(*wall.cell(), {.assembled = true, .target_range = wall.range()});
}

void Tube::ParticleData::set_shape(const Net& x, double x1, const stokes::DuctFlow& flow, Wall& wall, double pressure_drop) {
  origin = x1;
  shape = x;
  shape.col(0).array() -= origin;
  sites = collocation * shape;
  layers->set_shape(shape);
  flow_of_velocity_.resize(0, 3);
  Net points = wall.points().targets();
  std::vector<int> own_points = wall.points().own_targets();
  const auto n_on_wall = static_cast<int>(points.rows());
  if (periodic) {
    points.conservativeResize(n_on_wall + sites.rows(), 3);
    points.bottomRows(sites.rows()) = sites;
    for (const int i : own) own_points.push_back(n_on_wall + i);
  }
  targets = layers->prepared(std::move(points), std::move(own_points), n_on_wall);
  wall_on_sites.reset();
  if (has_double()) wall_on_sites = wall.layer().near(sites, own);
  if (!periodic) inlet = wall.inlet().integral(sites) / parameters.viscosity;
  weigh_pressure(flow, surface::properties(wall.surface().kind).parallel_flow);
  if (periodic) inlet = ambient / pressure_drop;
}

Tube::ParticleData::Cause Tube::ParticleData::cause(const Net& f, const Net& v) {
  Net u = Net::Zero(targets.at.rows(), 3);
  layers->add(f, v, targets, u);
  return {u.topRows(targets.first_image_row), u.bottomRows(u.rows() - targets.first_image_row)};
}

const Net& Tube::ParticleData::flow_of_velocity(const Wall& wall) {
  if (flow_of_velocity_.size() > 0) return flow_of_velocity_;
  Layer& layer = *layers->double_layer;
  const auto &node = layer.nodes(), &normal = layer.normals();
  std::vector<double> flow[3];
  for (auto& component : flow) component.assign(node[0].size(), 0.);
  for (std::size_t k = 0; k < node[0].size(); ++k) {
    const Vec3 one = wall.flow_of_double_layer(Vec3(node[0][k], node[1][k], node[2][k]), Vec3(normal[0][k], normal[1][k], normal[2][k]));
    for (int c = 0; c < 3; ++c) flow[c][k] = one[c];
  }
  flow_of_velocity_.resize(sites.rows(), 3);
  for (int c = 0; c < 3; ++c) flow_of_velocity_.col(c) = layer.moments(flow[c]);
  return flow_of_velocity_;
}

/// Computes the weights with which the control values of the load f and of the velocity v enter the pressure drop (2.7). `parallel`: see
/// DuctProperties::parallel_flow. If it is true, the flow rate of the disturbance is 0 for every load. Otherwise only the weights of f are computed.
void Tube::ParticleData::weigh_pressure(const stokes::DuctFlow& flow, bool parallel) {
  ambient = ambient_of(flow);
  Layer& layer = layers->single_layer;
  const auto n = static_cast<std::size_t>(layer.n_nodes());
  std::vector<double> flow_at[3], weighted(n);
  if (parallel) {
    set_columns(flow.velocities(as_net(layer.nodes())), flow_at);
  } else {
    interpolated_ambient = from_sites.solve(ambient);
    layer.values(interpolated_ambient, flow_at);
  }
  weights_of_load = Net::Zero(sites.rows(), 3), weights_of_velocity.resize(0, 3);
  for (int c = 0; c < (parallel ? 1 : 3); ++c) {
    for (std::size_t k = 0; k < n; ++k) weighted[k] = layer.weights()[k] * flow_at[c][k];
    weights_of_load.col(c) = layer.moments(weighted) / flow.flow_rate();
  }
  if (!has_double() || !parallel) return;
  set_columns(flow.tractions(as_net(layers->double_layer->nodes()), as_net(layers->double_layer->normals())), flow_at);
  weights_of_velocity.resize(sites.rows(), 3);
  for (int c = 0; c < 3; ++c) weights_of_velocity.col(c) = layers->double_layer->moments(flow_at[c]) / -flow.flow_rate();
}

/// Returns the duct flow at the sites. In a symmetric scene the flow is evaluated at the fundamental points only and completed by symmetry.
Net Tube::ParticleData::ambient_of(const stokes::DuctFlow& flow) const {
  const surface::Symmetry& symmetry = parameters.symmetry;
  if (symmetry.order() == 1) return flow.velocities(sites);
  const std::vector<int>& rows = symmetry.fundamental();
  Net all = Net::Zero(sites.rows(), 3);
  all(rows, Eigen::all) = flow.velocities(sites(rows, Eigen::all));
  symmetry.complete(all);
  return all;
}

void Tube::ParticleData::freeze(Wall& wall, const Net& pressure_of_wall) {
  using Targets = std::span<const int>;
  const double length = wall.surface().radius();
  const auto on_wall = [&](Layer& layer) {
    return [&](Targets targets, stokes::Rows<float>& rows) {
      const WallPoints& points = wall.points();
      points.collocate<float>(targets, [&](Targets at, stokes::Rows<float>& some) { layer.assemble(points.targets(), at, some); }, rows);
    };
  };
  frozen.single.assemble(wall.points().own(), space.n_points, on_wall(layers->single_layer), length);
  const Net weights = ranks.assembled<Net>(space.n_points, 3, [&](Net& sums) {
    if (!has_double()) return;
    frozen.dual.assemble(wall.points().own(), space.n_points, [&](Targets targets, stokes::Rows<float>& rows) {
      on_wall(*layers->double_layer)(targets, rows);
      Eigen::Map<Eigen::RowVectorXd> sum(sums.data(), sums.size());
      for (std::size_t k = 0; k < targets.size() && pressure_of_wall.size() > 0; ++k)
        for (int c = 0; c < 3; ++c) sum += pressure_of_wall(targets[k], c) * rows.row(static_cast<Eigen::Index>(3 * k) + c).cast<double>();
    });
  });
  const auto of_images = [&](Layer& layer) {
    return [&](Targets targets, stokes::Rows<float>& rows) { layer.assemble_images(sites, targets, rows); };
  };
  frozen.images = periodic && space.n_points < SolverOptions::nodes_worth_a_tree;
  if (frozen.images) frozen.single_of_images.assemble(own, space.n_points, of_images(layers->single_layer), length);
  if (frozen.images && has_double()) frozen.dual_of_images.assemble(own, space.n_points, of_images(*layers->double_layer));
  frozen.wall.assemble(own, static_cast<int>(wall.points().sites().rows()), [&](Targets targets, stokes::Rows<float>& rows) {
    wall.layer().assemble(sites, targets, rows);
    wall.from_space(rows);
  }, length);
  frozen.inlet = inlet, frozen.ambient = ambient, frozen.weights_of_load = weights_of_load, frozen.weights_of_velocity = weights_of_velocity;
  if (pressure_of_wall.size() > 0) frozen.weights_of_velocity = weights;
}

}  // namespace tanktread::coupling
