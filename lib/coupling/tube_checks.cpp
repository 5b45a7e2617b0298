// Independent routes to the pressure drop, and the distance to the wall.

#include <algorithm>

#include "coupling/tube_particle.hpp"
#include "surface/clearance.hpp"

namespace tanktread::coupling {

namespace {

/// Points of a section between its centroid and its outline, as far as they are inside.
std::vector<Vec3> points_of_cap(const surface::Outline& outline, double place) {
  std::vector<Vec3> points;
  const surface::Vec2 centre = outline.centroid();
  for (int k = 0; k < outline.n_sides(); ++k)
    for (const double u : outline.knots(k, std::max(2, 12 / outline.n_sides())))
      for (const double share : {0.25, 0.5, 0.75, 0.9}) {
        const surface::Vec2 p = centre + share * (outline.point(k, u) - centre);
        if (outline.inside(p)) points.emplace_back(place, p[0], p[1]);
      }
  return points;
}

std::vector<int> everybody(Eigen::Index n) {
  std::vector<int> all(static_cast<std::size_t>(n));
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  return all;
}

}  // namespace

/// The flow rate through the inlet is the transpose of c: of a force f at y it is f.c(y)/mu. So no point of the cap is needed.
Tube::Checks Tube::checks(const Net& f, const Net& v, const Response& response) {
  Particle& particle = *particle_;
  const double mu = viscosity(), dp = response.pressure_drop;
  const double area = wall_->surface().outline.area();
  const stokes::Cap& inlet = wall_->inlet();
  if (flow_weights_.size() == 0) {
    flow_weights_ = wall_->flow_weights();
    force_weights_ = wall_->force_weights();
    own_flow_ = inlet.own_flow();
  }

  double flow = -dot(flow_weights_, response.wall_traction) / mu + dp / mu * own_flow_;
  double force = area * dp - dot(force_weights_, response.wall_traction);
  std::vector<double> value[3];
  if (f.size() > 0) {
    particle.single.values(f, value);
    const auto& node = particle.single.nodes();
    for (std::size_t k = 0; k < value[0].size(); ++k) {
      const Net at = (Net(1, 3) << node[0][k], node[1][k], node[2][k]).finished();
      const Vec3 strength = particle.single.weights()[k] * Vec3(value[0][k], value[1][k], value[2][k]);
      flow -= inlet.integral(at).row(0).dot(strength) / mu;
      force -= strength[0];
    }
  }
  if (v.size() > 0 && particle.dual) {
    particle.dual->values(particle.strength(v), value);
    const auto &node = particle.dual->nodes(), &normal = particle.dual->normals();
    for (std::size_t k = 0; k < value[0].size(); ++k)
      flow += inlet.double_layer_flow(Vec3(node[0][k], node[1][k], node[2][k]), Vec3(value[0][k], value[1][k], value[2][k]),
                                      Vec3(normal[0][k], normal[1][k], normal[2][k]));
  }
  const double flow_of_pressure = -dot(flow_weights_, wall_->pumped()) / mu + own_flow_ / mu;
  const double force_of_pressure = area - dot(force_weights_, wall_->pumped());

  Checks checks;
  checks.flux = flow / flow_->flow_rate();
  checks.force = force / (area * flow_->pressure_gradient() * flow_->radius());
  checks.cap_velocity = cap_velocity(f, v, response) / flow_->mean_velocity();
  checks.pressure_by_flux = dp - flow / flow_of_pressure;
  checks.pressure_by_force = dp - force / force_of_pressure;
  return checks;
}

double Tube::cap_velocity(const Net& f, const Net& v, const Response& response) {
  Particle& particle = *particle_;
  const double mu = viscosity();
  std::vector<Vec3> points = points_of_cap(wall_->surface().outline, wall_->surface().start);
  const std::vector<Vec3> outlet = points_of_cap(wall_->surface().outline, wall_->surface().end);
  points.insert(points.end(), outlet.begin(), outlet.end());
  Net at(static_cast<Eigen::Index>(points.size()), 3), part = at;
  for (std::size_t k = 0; k < points.size(); ++k) at.row(static_cast<Eigen::Index>(k)) = points[k].transpose();
  const std::vector<int> all = everybody(at.rows());
  Net u = response.pressure_drop / mu * wall_->inlet().integral(at);
  wall_->layer().apply(response.wall_traction, at, all, part);
  u -= part / mu;
  if (f.size() > 0) {
    particle.single.apply(f, at, all, part);
    u -= part / mu;
  }
  if (v.size() > 0 && particle.dual) {
    particle.dual->apply(particle.strength(v), at, all, part);
    u += part;
  }
  return u.rowwise().norm().maxCoeff();
}

double Tube::gap() const {
  return surface::clearance(surface::Patches(particle_->geometry.bezier(), particle_->shape), wall_->surface().outline).gap;
}

}  // namespace tanktread::coupling
