#include "system/power_balance.hpp"

#include <cmath>
#include <limits>

#include "base/indices.hpp"
#include "quadrature/gauss.hpp"
#include "surface/geometry.hpp"
#include "system/solids/ducts/duct.hpp"
#include "system/targets/collocation.hpp"
#include "system/solids/bodies/rigid_residual.hpp"

namespace tanktread::coupling {

namespace {

/// Returns the rule of two Gauss points per direction. Between collocation sites the error of the velocity varies like t^2 (1 - t)^2, with t from 0
/// to 1 between two sites. The midpoint rule would overestimate the mean of this function by a factor of about two.
const quadrature::TensorRule& rule() { return quadrature::tensor_gauss(2); }

/// Returns the 2 x 2 Gauss points of all elements, in the order of the elements.
stokes::Sites gauss_points(const spline::Space& space) {
  stokes::Sites sites;
  for (int e = 0; e < static_cast<int>(space.elements.size()); ++e)
    for (int q = 0; q < rule().size(); ++q) sites.push_back({{e, rule().s[q], rule().t[q]}});
  return sites;
}

}  // namespace

constexpr double noise = 1e-5;  // quotient of the powers and Powers::scale below which the powers are errors of quadrature

double turnover(double flow, double forces, double fluids) {
  return (std::abs(flow) + std::abs(forces) + std::abs(fluids) + std::abs(flow + forces - fluids)) / 2;
}

void Powers::add_columns(Columns& to) const {
  const double all = turnover(flow, forces, fluids);
  to.add(flow, {"flow_power", "force length/time",
                "power input by the ambient flow due to the particles, in addition to its power input without particles (6.11)"});
  to.add(forces, {"force_power", "force length/time",
                  "power input by the weight of particles, by forces on membranes and rigid bodies, and by contact forces"});
  to.add(fluids,
         {"fluid_dissipation", "force length/time",
          "viscous dissipation in the fluids due to the particles, in addition to the dissipation without particles (6.12)"});
  to.add(all > noise * scale ? residual / all : std::numeric_limits<double>::quiet_NaN(),
         {"power_residual", "1", "residual of the power balance (6.13), divided by half the sum of the magnitudes of its terms",
          "half the sum of the magnitudes is less than 1e-5 of the integral of (|load| + viscosity x speed/radius) x speed over the surfaces: all "
          "powers are then zero up to errors of quadrature"});
}

PowerBalance::PowerBalance(Capsule& capsule, const Ranks& ranks)
    : capsule_(capsule), space_(capsule.membrane().space()), gauss_points_(gauss_points(space_)),
      values_(value_matrix(space_, gauss_points_)), mass_(space_),
      layers_(space_, gauss_points_, values_, capsule.solver().membranes().unstressed(), capsule.parameters(), capsule.parameters().quadrature,
              capsule.solver().walls(), ranks) {}

Powers PowerBalance::operator()(const Net& x, const Net& slope) {
  const std::shared_ptr<Evaluation> e = capsule_.evaluate_on_demand(x, slope, 0);
  if (capsule_.slides() || capsule_.solver().load_depends_on_unknowns()) e->solve();
  const Net load = e->load(), v = e->fluid_velocity();
  const RigidParticles rigid = capsule_.rigid_at(x);
  const Net measured = capsule_.solver().membranes().measured_net(x);
  const auto& mass = mass_.update(measured);
  const Net work = mass * load, drag = capsule_.parameters().viscosity * mass * v, inside = density(v, rigid);
  Powers powers;
  powers.flow = flow_power(*e, work, inside);
  Net stored = Net::Zero(x.rows(), 3);
  const std::vector<int> all = indices(space_.elements.size());
  capsule_.membrane().load(x, all, stored);
  capsule_.solver().membranes().loads().add_stored_work(x, stored);
  for (std::size_t p = 0; p < capsule_.particles().size(); ++p) {
    const Particle& particle = capsule_.particles()[p];
    const auto sizes = [&](const Net& of) { return particle.block.rows(of).rowwise().norm().eval(); };
    powers.scale += (sizes(work) + sizes(drag) / particle.radius).dot(sizes(v));
    if (particle.rigid) continue;
    powers.membranes += e->membrane_dissipation(p);
    powers.storing += dot(particle.block.rows(v), particle.block.rows(stored));
  }
  const double done = dot(work, v);  // power that the fluids transfer to all surfaces; the fluids dissipate the power `flow` minus this power
  powers.fluids = powers.flow - done;
  powers.forces = powers.storing + powers.membranes - done;
  powers.residual = residual_power(load, residual_velocity(*e, v, rigid, load), x, measured);
  return powers;
}

/// Returns the power input by the flow due to the particles. In a duct flow, it is the flow rate times the additional pressure drop (2.7). Between
/// two plates or among posts, it is sum_s V_s.F_s + g.int u dV. V_s is the velocity of solid s, F_s the change of its force on the fluid due to the
/// particles, g the pressure gradient, and u the velocity that the particles cause. All other flows are affine or parabolic, and their power is
/// (6.11). If there is a tube or a plane wall, the wall moves with this flow.
double PowerBalance::flow_power(Evaluation& e, const Net& work, const Net& inside) {
  const stokes::AmbientFlow& flow = capsule_.flow();
  if (flow.duct()) {
    const Tube& tube = *capsule_.tube();
    const double drop = e.response().pressure_drop;
    return tube.duct().flow_rate(drop, flow.amplitude()) * drop;
  }
  if (SolidResponse* const solids = capsule_.solids(); solids && solids->scene().planes.size() != 1) {
    const Evaluation::SolidFlow found = e.solid_flow();
    const Mat3 change = flow.change();
    return solids->scene().solids->power(found.caused.force * change) + (change * solids->scene().driving_gradient).dot(found.caused_integral);
  }
  const Net& x = e.x();
  const Targets& targets = capsule_.solver().targets();
  const Net flux = capsule_.geometry().volume_gradient(x), at = targets.at_sites() * x;
  const std::vector<Mat3> gradients = flow.gradients(at);
  Net stressed = targets.at_sites() * inside;  // `inside` at the sites; multiplied by the stress of the flow below
  for (Eigen::Index i = 0; i < at.rows(); ++i) {
    const double pressure = 2 * flow.curvature().trace() * flow.quadratic_direction().dot(at.row(i));  // pressure of the flow, divided by viscosity
    const Mat3& gradient = gradients[static_cast<std::size_t>(i)];
    stressed.row(i) = capsule_.parameters().viscosity * stressed.row(i) * (gradient + gradient.transpose() - pressure * Mat3::Identity());
  }
  stressed = targets.collocated(stressed);
  double power = dot(work, targets.collocated(flow.velocities(at)));
  for (const Particle& particle : capsule_.particles())
    power -= viscosity_contrast(particle) * dot(particle.block.rows(stressed), particle.block.rows(flux));
  return power;
}

/// Returns int (Df - p n).r over all particles by Gauss quadrature, where Df is the load, r the residual velocity, and p the mean of Df.n over each
/// particle. p is subtracted because a uniform pressure does no work; the quadrature error of its single layer then has no effect.
double PowerBalance::residual_power(const Net& load, const Net& residual_velocity, const Net& x, const Net& measured) const {
  const Net loads = values_ * load;
  double sum = 0;
  for (const Particle& particle : capsule_.particles()) {
    double area = 0, pressure = 0, flux = 0;
    const int first = particle.block.first_element * rule().size(), n = particle.block.n_elements * rule().size();
    for (int i = first; i < first + n; ++i) {
      const spline::Site& site = gauss_points_[static_cast<std::size_t>(i)].front();
      const double weight = rule().weights[i % rule().size()];
      const surface::Point at = surface::point(space_, x, site);
      const Vec3 force = weight * surface::point(space_, measured, site).jacobian * loads.row(i).transpose(), residual = residual_velocity.row(i);
      sum += force.dot(residual);
      area += weight * at.jacobian, pressure += force.dot(at.n), flux += weight * at.jacobian * at.n.dot(residual);
    }
    sum -= pressure / area * flux;
  }
  return sum;
}

/// Returns the density of the double layers: the velocity v, or for rigid bodies the unknown density w of (2.23).
Net PowerBalance::density(const Net& v, const RigidParticles& rigid) const {
  Net all = v;
  for (std::size_t p = 0; p < capsule_.particles().size(); ++p)
    if (rigid.is_rigid(p) && rigid.density(p).size() > 0) capsule_.particles()[p].block.rows(all) = rigid.density(p);
  return all;
}

/// Returns the residual of the boundary integral equation (2.22), the velocity v minus the right-hand side, at the Gauss points.
Net PowerBalance::residual_velocity(Evaluation& e, Net v, const RigidParticles& rigid, const Net& load) {
  Net x = e.x();
  const stokes::AmbientFlow& flow = capsule_.flow();
  if (const auto& cell = capsule_.cell(); cell && !capsule_.tube()) layers_.repeat(*cell);
  capsule_.solver().move_into_cell(x, &v);
  const FluidWalls::Response response = e.wall_response();
  layers_.set_shape(x, flow.velocities(values_ * x));
  return values_ * v - velocities(layers_, {.load = load, .density = density(v, rigid), .walls = response, .ambient = true});
}

}  // namespace tanktread::coupling
