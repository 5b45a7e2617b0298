#include "system/solids/ducts/tube_particle.hpp"

#include <span>
#include <utility>
#include <vector>

#include "system/targets/collocation.hpp"

namespace tanktread::coupling {

Tube::ParticleData::ParticleData(const spline::Space& particle, const TubeParameters& how, Duct& around, Phases& phases)
    : space(particle),
      parameters(how),
      duct(around),
      geometry(particle),
      collocation(collocation_matrix(particle)),
      from_sites(how.direct) {
  sites.own = ranks.divide_points(space, parameters.symmetry.order() > 1 ? parameters.symmetry : surface::Symmetry(space.n_points));
  from_sites.factor(collocation);
  ranks.measure(phases);
}

void Tube::ParticleData::set_particles(const Net& unstressed, std::span<const Particle> particles) {
  layers.emplace(space, stokes::Sites(), unstressed, particles, parameters.quadrature, parameters.viscosity);
  const Wall& wall = duct.wall();
  if (wall.cell()) layers->repeat(*wall.cell(), {.assembled = true, .target_range = wall.range()});
}

void Tube::ParticleData::set_shape(const Net& x, double x1) {
  Wall& wall = duct.wall();
  origin = x1;
  shape = x;
  shape.col(0).array() -= origin;
  layers->set_shape(shape);
  flow_of_velocity_.resize(0, 3);
  sites.at = collocation * shape;
  sites.near.reset();
  if (has_double()) sites.near = wall.layer().near(sites.at, sites.own);
  Net points = wall.points().targets();
  std::vector<int> own = wall.points().own_targets();
  const auto n_on_wall = static_cast<int>(points.rows());
  if (wall.cell()) {
    points.conservativeResize(n_on_wall + sites.at.rows(), 3);
    points.bottomRows(sites.at.rows()) = sites.at;
    for (const int i : sites.own) own.push_back(n_on_wall + i);
  }
  targets = layers->prepared(std::move(points), std::move(own), n_on_wall);
  weigh_pressure();
}

Tube::ParticleData::Cause Tube::ParticleData::cause(const Net& f, const Net& v) {
  Net u = Net::Zero(targets.at.rows(), 3);
  layers->add(f, v, targets, u);
  return {u.topRows(targets.first_image_row), u.bottomRows(u.rows() - targets.first_image_row)};
}

const Net& Tube::ParticleData::flow_of_velocity() {
  if (flow_of_velocity_.size() == 0) flow_of_velocity_ = duct.disturbed_flow_rate().weights_of_velocity(*layers);
  return flow_of_velocity_;
}

/// Computes the flow of the empty duct at the sites, and the weights with which the control values of the load f and of the velocity v enter the
/// pressure drop (2.7). If the flow is parallel, the flow rate of the disturbance is 0 for every load. Otherwise only the weights of f are computed.
void Tube::ParticleData::weigh_pressure() {
  const stokes::DuctFlow& flow = duct.flow();
  in_flow.ambient = ambient();
  // in a periodic duct equal to the function called here, but symmetric and without another evaluation of the flow
  in_flow.per_pressure_drop = duct.wall().cell() ? Net(in_flow.ambient / duct.pressure_drop()) : duct.velocity_per_pressure_drop(sites.at);
  if (!parallel()) in_flow.control_values = from_sites.solve(in_flow.ambient);
  const auto ambient_at = [&](const Net& x) { return parallel() ? flow.velocities(x) : layers->at_nodes(in_flow.control_values); };
  in_flow.weights_of_load = layers->weights_of_load(ambient_at) / flow.flow_rate();
  in_flow.weights_of_velocity.resize(0, 3);
  if (!has_double() || !parallel()) return;
  const auto traction = [&](const Net& x, const Net& n) { return flow.tractions(x, n); };
  in_flow.weights_of_velocity = layers->weights_of_velocity(traction) / -flow.flow_rate();
}

/// Returns the duct flow at the sites. In a symmetric scene the flow is evaluated at the fundamental points only and completed by symmetry.
Net Tube::ParticleData::ambient() const {
  const surface::Symmetry& symmetry = parameters.symmetry;
  if (symmetry.order() == 1) return duct.flow().velocities(sites.at);
  const std::vector<int>& rows = symmetry.fundamental();
  Net all = Net::Zero(sites.at.rows(), 3);
  all(rows, Eigen::all) = duct.flow().velocities(sites.at(rows, Eigen::all));
  symmetry.complete(all);
  return all;
}

/// If the flow is not parallel, also computes the weights of the particle's velocity v in dp: the product of the double layer and the weights of a
/// velocity on the wall. For accuracy, the rows of the double layer are rounded only afterwards.
void Tube::ParticleData::freeze() {
  using Targets = std::span<const int>;
  Wall& wall = duct.wall();
  const WallPoints& points = wall.points();
  const double length = wall.surface().radius();
  const bool by_flow = !parallel() && has_double();
  const Net of_wall = by_flow ? Net(duct.disturbed_flow_rate().weights_of_wall_velocity()) : Net();
  const Net weights = ranks.assembled<Net>(space.n_points, 3, [&](Net& sums) {
    frozen.on_wall.assemble(points.own(), space.n_points, *layers, length, [&](stokes::Layer& layer, Targets own, stokes::Rows<float>& rows) {
      points.collocate<float>(own, [&](Targets at, stokes::Rows<float>& some) { layer.assemble(points.targets(), at, some); }, rows);
      if (!by_flow || &layer == &layers->single_layer) return;
      Eigen::Map<Eigen::RowVectorXd> sum(sums.data(), sums.size());
      for (std::size_t k = 0; k < own.size(); ++k)
        for (int c = 0; c < 3; ++c) sum += of_wall(own[k], c) * rows.row(static_cast<Eigen::Index>(3 * k) + c).cast<double>();
    });
  });
  frozen.images = wall.cell() && space.n_points < SolverOptions::nodes_worth_a_tree;
  if (frozen.images)
    frozen.of_images.assemble(sites.own, space.n_points, *layers, length, [&](stokes::Layer& layer, Targets some, stokes::Rows<float>& rows) {
      layer.assemble_images(sites.at, some, rows);
    });
  frozen.wall.assemble(sites.own, static_cast<int>(points.sites().rows()), [&](Targets some, stokes::Rows<float>& rows) {
    wall.layer().assemble(sites.at, some, rows);
    wall.from_space(rows);
  }, length);
  frozen.in_flow = in_flow;
  if (by_flow) frozen.in_flow.weights_of_velocity = (weights - flow_of_velocity()) / duct.disturbed_flow_rate().per_pressure_drop();
}

}  // namespace tanktread::coupling
