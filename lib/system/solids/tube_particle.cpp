#include "system/solids/tube_particle.hpp"

#include <span>
#include <vector>

#include "base/indices.hpp"
#include "system/collocation.hpp"
#include "system/solids/nearest_sites.hpp"

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

Tube::Particle::Particle(const spline::Space& particle, const TubeParameters& how, const Wall& wall)
    : space(particle),
      parameters(how),
      geometry(particle),
      collocation(collocation_matrix(particle)),
      from_sites(how.direct),
      single(Layer::Kernel::single_layer, particle, {}, how.quadrature) {
  own = ranks.divide_points(space, parameters.symmetry.order() > 1 ? parameters.symmetry : surface::Symmetry(space.n_points));
  from_sites.factor(collocation);
  if (wall.cell()) {
    period.emplace(Period{*wall.cell(), wall.across(), {}, {}});
    single.repeat(period->cell, {.assembled = true, .across = period->across});
  }
  set_contrasts(Eigen::VectorXd::Constant(space.n_points, 1 - how.viscosity_ratio));
}

void Tube::Particle::set_contrasts(const Eigen::VectorXd& of_points) {
  contrasts = of_points;
  dual.reset();
  if (contrasts.isZero(0)) return;
  dual.emplace(Layer::Kernel::double_layer, space, stokes::Sites(), parameters.quadrature);
  if (period) dual->repeat(period->cell, {.assembled = true, .across = period->across});
}

void Tube::Particle::place(const Net& x, double origin, const stokes::DuctFlow& flow, Wall& wall, double pressure_drop) {
  centroid = origin;
  shape = x;
  shape.col(0).array() -= centroid;
  sites = collocation * shape;
  flow_of_strength_.resize(0, 3);
  if (!period) inlet = wall.inlet().integral(sites) / parameters.viscosity;
  single.place(shape, measure);
  if (period) {
    const auto n = static_cast<int>(wall.points().targets().rows());
    period->targets.resize(n + sites.rows(), 3);
    period->targets << wall.points().targets(), sites;
    period->own = wall.points().own_targets();
    for (const int i : own) period->own.push_back(n + i);
  }
  if (dual) {
    dual->place(shape);
    nearest = nearest_sites(sites, wall.points().targets(), indices(wall.points().targets().rows()), period ? &period->cell : nullptr);
    if (period) {
      dual->see_images_only(static_cast<int>(wall.points().targets().rows()));
      dual_on_wall = dual->near(period->targets, period->own);
    } else {
      dual_on_wall = dual->near(wall.points().targets(), wall.points().own_targets());
    }
    wall_on_sites = wall.layer().near(sites, own);
  }
  weigh_pressure(flow, !wall.surface().channel);
  if (period) inlet = ambient / pressure_drop;
}

void Tube::Particle::add_images(const Net& f, const Net& v, const Net& at, std::span<const int> rows, Net& u) {
  Net part(at.rows(), 3);
  const auto add = [&](Layer& layer, const Net& density) {
    layer.see_images_only(0);
    layer.apply(density, at, rows, part);
    for (const int i : rows) u.row(i) += part.row(i);
  };
  if (f.size() > 0) add(single, -f / parameters.viscosity);
  if (v.size() > 0 && dual) add(*dual, strength(v));
}

Tube::Particle::Cause Tube::Particle::cause(const Net& f, const Net& v, const Wall& wall) {
  const auto n = wall.points().targets().rows();
  const auto& [cell, across, both, own_of_both] = *period;
  Net u = Net::Zero(both.rows(), 3), part(both.rows(), 3);
  if (f.size() > 0) {
    single.see_images_only(static_cast<int>(n));
    single.apply(f, both, own_of_both, part);
    for (const int i : own_of_both) u.row(i) -= part.row(i) / parameters.viscosity;
  }
  if (v.size() > 0 && dual) {
    const Net density = strength(v);
    Net nearby = Net::Zero(both.rows(), 3);
    nearby.topRows(n) = nearest_values(density);
    dual->see_images_only(static_cast<int>(n));
    dual->apply(density, nearby, both, own_of_both, part, kept(dual_on_wall));
    for (const int i : own_of_both) u.row(i) += part.row(i);
  }
  return {u.topRows(n), u.bottomRows(sites.rows())};
}

const Net& Tube::Particle::flow_of_strength(const Wall& wall) {
  if (flow_of_strength_.size() > 0) return flow_of_strength_;
  const auto &node = dual->nodes(), &normal = dual->normals();
  std::vector<double> flow[3];
  for (auto& component : flow) component.assign(node[0].size(), 0.);
  for (std::size_t k = 0; k < node[0].size(); ++k) {
    const Vec3 one = wall.flow_of_double_layer(Vec3(node[0][k], node[1][k], node[2][k]), Vec3(normal[0][k], normal[1][k], normal[2][k]));
    for (int c = 0; c < 3; ++c) flow[c][k] = one[c];
  }
  flow_of_strength_.resize(sites.rows(), 3);
  for (int c = 0; c < 3; ++c) flow_of_strength_.col(c) = dual->moments(flow[c]);
  return flow_of_strength_;
}

/// Computes the weights with which the control values of the load f and of the velocity v enter the pressure drop (2.7). In a straight tube v_inf and
/// f_inf (2.7) are evaluated at the quadrature nodes, so that the flow rate of the disturbance is 0 for every load. In a channel v_inf is
/// interpolated from the collocation points, because its values at the nodes would require integrals over the wall. In a channel only the weights of
/// f are computed.
void Tube::Particle::weigh_pressure(const stokes::DuctFlow& flow, bool straight) {
  ambient = ambient_of(flow);
  const auto n = static_cast<std::size_t>(single.n_nodes());
  std::vector<double> flow_at[3], weighted(n);
  if (straight) {
    set_columns(flow.velocities(as_net(single.nodes())), flow_at);
  } else {
    interpolated_ambient = from_sites.solve(ambient);
    single.values(interpolated_ambient, flow_at);
  }
  pressure_of_load = Net::Zero(sites.rows(), 3);
  for (int c = 0; c < (straight ? 1 : 3); ++c) {
    for (std::size_t k = 0; k < n; ++k) weighted[k] = single.weights()[k] * flow_at[c][k];
    pressure_of_load.col(c) = single.moments(weighted) / flow.flow_rate();
  }
  if (!dual || !straight) return;
  set_columns(flow.tractions(as_net(dual->nodes()), as_net(dual->normals())), flow_at);
  pressure_of_velocity.resize(sites.rows(), 3);
  for (int c = 0; c < 3; ++c) pressure_of_velocity.col(c) = contrasts.cwiseProduct(dual->moments(flow_at[c])) / -flow.flow_rate();
}

/// Returns the duct flow at the sites. In a symmetric scene the flow is evaluated at the fundamental points only and completed by symmetry.
Net Tube::Particle::ambient_of(const stokes::DuctFlow& flow) const {
  const surface::Symmetry& symmetry = parameters.symmetry;
  if (symmetry.order() == 1) return flow.velocities(sites);
  const std::vector<int>& rows = symmetry.fundamental();
  Net all = Net::Zero(sites.rows(), 3);
  all(rows, Eigen::all) = flow.velocities(sites(rows, Eigen::all));
  symmetry.complete(all);
  return all;
}

Net Tube::Particle::nearest_values(const Net& v) const {
  const Net at_sites = collocation * v;
  return at_sites(nearest, Eigen::all);
}

void Tube::Particle::freeze(Wall& wall, const Net& pressure_of_wall) {
  using Targets = std::span<const int>;
  const auto on_wall = [&](Layer& layer) {
    return [&](Targets targets, stokes::Rows<float>& rows) {
      const WallPoints& points = wall.points();
      points.collocate<float>(targets, [&](Targets at, stokes::Rows<float>& some) { layer.assemble(points.targets(), at, some); }, rows);
    };
  };
  frozen.single.assemble(wall.points().own(), space.n_points, on_wall(single));
  const Net weights = ranks.assembled<Net>(space.n_points, 3, [&](Net& sums) {
    if (!dual) return;
    frozen.dual.assemble(wall.points().own(), space.n_points, [&](Targets targets, stokes::Rows<float>& rows) {
      on_wall(*dual)(targets, rows);
      Eigen::Map<Eigen::RowVectorXd> sum(sums.data(), sums.size());
      for (std::size_t k = 0; k < targets.size() && pressure_of_wall.size() > 0; ++k)
        for (int c = 0; c < 3; ++c) sum += pressure_of_wall(targets[k], c) * rows.row(static_cast<Eigen::Index>(3 * k) + c).cast<double>();
    });
  });
  frozen.wall.assemble(own, static_cast<int>(wall.points().sites().rows()), [&](Targets targets, stokes::Rows<float>& rows) {
    wall.layer().assemble(sites, targets, rows);
    wall.from_space(rows);
  });
  frozen.inlet = inlet, frozen.ambient = ambient, frozen.pressure_of_load = pressure_of_load, frozen.pressure_of_velocity = pressure_of_velocity;
  if (pressure_of_wall.size() > 0) frozen.pressure_of_velocity = contrasts.asDiagonal() * weights;
}

stokes::Evaluations Tube::Particle::evaluations() const {
  stokes::Evaluations sum = single.evaluations();
  return dual ? sum + dual->evaluations() : sum;
}

}  // namespace tanktread::coupling
