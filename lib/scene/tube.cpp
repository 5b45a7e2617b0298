#include "scene/tube.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/words.hpp"
#include "scene/memory.hpp"
#include "scene/room.hpp"
#include "surface/clearance.hpp"
#include "surface/closest_points.hpp"
#include "surface/geometry.hpp"
#include "system/solids/ducts/channel_flow.hpp"
#include "system/solids/ducts/duct.hpp"

namespace tanktread {

namespace {

/// Throws NoRoom if the particle does not fit into the channel: if a sample point of its surface is in the wall or too close to an end, or if the
/// gap to the wall is too small.
void check_fits_channel(const ParticleScene& particle_scene, const Body& body, const surface::TubeWall& wall) {
  const surface::Channel& channel = *wall.channel;
  const surface::Patches particle(surface::BezierMap(body.space), body.initial), around(surface::BezierMap(wall.space), wall.net);
  double first = channel.end(), last = channel.start();
  for (int e = 0; e < particle.size(); ++e)
    for (const auto& line : surface::sample(particle[e]))
      for (const Vec3& x : line) {
        const Vec3 at = channel.coordinates(x);
        if (!channel.outline().inside(at.tail<2>()))
          throw NoRoom(formatted("The particle does not fit into the channel: at [%.4g, %.4g, %.4g] it is in the wall; R_C = %.4g, half the "
                                 "channel's width is %.4g where it is narrowest.",
                                 x[0], x[1], x[2], body.radius, channel.smallest_radius()),
                       0);
        first = std::min(first, at[0]), last = std::max(last, at[0]);
      }
  const double margin = 1.7 * wall.radius();
  if (!channel.repeats() && (first < channel.start() + margin || last > channel.end() - margin))
    throw NoRoom(formatted("The particle, from s = %.4g to %.4g, is too close to an end of the channel: 1.7 R_T = %.4g must be left to "
                           "Channel/start = %.4g and Channel/end = %.4g.",
                           first, last, margin, channel.start(), channel.end()),
                 margin);
  const surface::ElementBoxes walls(around);
  const double least = particle_scene.contact_length(particle_scene.tube.contact_gap);
  const double gap = surface::gap_to_wall(surface::BezierMap(body.space), body.initial, {}, walls, wall.period, 1e-5 * wall.radius(), least);
  if (gap < least)
    throw NoRoom(formatted("The particle starts too close to the channel's wall: the gap is %.4g, less than Channel/contact gap, %g R_C = %.4g.",
                           gap, particle_scene.tube.contact_gap, least),
                 gap);
}

/// Throws NoRoom if the particle does not fit into the straight tube, or if the gap to the wall is too small.
void check_fits_tube(const ParticleScene& particle_scene, const Body& body) {
  const surface::Outline& outline = body.duct->outline();
  const Vec3& centre = particle_scene.particle.shape.center;
  const double from_axis = outline.distance({centre[1], centre[2]});
  if (from_axis <= 0)
    throw NoRoom(formatted("Particle/center [%g, %g, %g] is outside of the tube, %g beyond its wall.", centre[0], centre[1], centre[2], -from_axis),
                 from_axis);
  const surface::Clearance nearest = surface::clearance(surface::Patches(surface::BezierMap(body.space), body.initial), outline);
  const std::string where = formatted("at (x2, x3) = (%.4g, %.4g)", nearest.x[1], nearest.x[2]);
  if (nearest.gap <= 0)
    throw NoRoom(formatted("The particle does not fit into the tube: %s it reaches %.4g beyond the wall; R_C = %.4g, R_T = %.4g.", where.c_str(),
                           -nearest.gap, body.radius, outline.radius()),
                 nearest.gap);
  const double least = particle_scene.contact_length(particle_scene.tube.contact_gap);
  if (nearest.gap < least)
    throw NoRoom(formatted("The particle starts too close to the tube's wall: %s the gap is %.4g, less than Tube/contact gap, %g R_C = %.4g.",
                           where.c_str(), nearest.gap, particle_scene.tube.contact_gap, least),
                 nearest.gap);
}

void check_fits(const ParticleScene& particle_scene, const Body& body) {
  switch (particle_scene.tube.kind()) {
    case surface::DuctKind::straight_tube: return check_fits_tube(particle_scene, body);
    case surface::DuctKind::channel: return check_fits_channel(particle_scene, body, *body.duct->fixed_wall());
  }
}

/// Adds the flow rate and the pressure drops of the empty duct to the row. They are 0 if `flow` is not a duct flow.
TubeRow with_channel(const coupling::Tube& tube, const stokes::AmbientFlow& flow, TubeRow now) {
  const double amplitude = flow.duct() ? flow.amplitude() : 0;
  now.flow_rate = tube.duct().flow_rate(now.pressure_drop, amplitude);
  now.channel_pressure_drop = amplitude * tube.flow().pressure_drop(tube.wall().length());
  now.channel_extra_pressure_drop = amplitude * tube.flow().extra_pressure_drop();
  return now;
}

}  // namespace

void reject_with_tube(const ParticleScene& particle_scene, Rejections& to) {
  const stokes::FlowOptions& flow = particle_scene.flow;
  const bool tube = particle_scene.tube.present;
  const bool fixed = tube && surface::properties(particle_scene.tube.kind()).fixed;
  const Chosen confined = particle_scene.duct_choice();
  to.pair(!particle_scene.runs_in_time() && fixed && flow.held == "flow rate", particle_scene.sought(), "Flow/held `flow rate`",
          "a particle in a channel moves with the fluid if the flow rate is prescribed, and can be at rest only if the pressure drop is; "
          "give `pressure drop`");
  const bool couette = tube && !fixed && flow.type == "simple shear" && !flow.history;
  to.pair(tube && !couette && flow.type != "duct" && flow.type != "quiescent", confined, particle_scene.flow_choice(),
          "that flow is for unbounded fluid; in a tube Flow/type is `duct`, `quiescent` or, in a straight tube and without Flow/history, "
          "`simple shear`, with which the wall moves");
  to.pair(tube && particle_scene.domain.present && particle_scene.tube.length, "Tube/length", "Domain",
          "the length of a periodic tube is its period");
  to.pair(tube && particle_scene.quadrature.rule == quadrature::LayerRule::desingularised, "Quadrature/rule `desingularised`", confined,
          reason::desingularised);
}

void check_fit(const ParticleScene& particle_scene, const Body& body) {
  if (!particle_scene.tube.present) return;
  try {
    check_fits(particle_scene, body);
  } catch (const NoRoom& error) {
    if (particle_scene.name.empty()) throw;
    throw NoRoom(particle_scene.path() + ": " + error.what(), error.gap);
  }
}

std::shared_ptr<const stokes::DuctFlow> make_duct(const ParticleScene& particle_scene) {
  if (!particle_scene.tube.present) return {};
  const double speed = particle_scene.unit_speed();
  switch (particle_scene.tube.kind()) {
    case surface::DuctKind::straight_tube:
      return std::make_shared<const stokes::DuctFlow>(particle_scene.tube, particle_scene.flow.viscosity, speed);
    case surface::DuctKind::channel:
      return std::make_shared<const coupling::ChannelFlow>(particle_scene.tube, particle_scene.flow.viscosity, speed, particle_scene.quadrature,
                                                           coupling::WallSolver{particle_scene.solvers.wall, particle_scene.solvers.tolerance},
                                                           particle_scene.walls);
  }
  throw std::logic_error("this DuctKind has no flow");
}

namespace {

std::shared_ptr<const surface::TubeWall> make_straight_wall(const SharedOptions& shared, const Body& body) {
  const surface::Outline& outline = body.duct->outline();
  double first = 0, last = 0;  // smallest and largest x1, relative to the centroid, in the resting and the initial shape
  for (const Net* net : {&body.rest, &body.initial}) {
    const Eigen::ArrayXd x1 = net->col(0).array() - surface::measures(body.space, *net).centroid[0];
    first = std::min(first, x1.minCoeff()), last = std::max(last, x1.maxCoeff());
  }
  const double length = last - first;
  surface::TubeOptions options = shared.tube;
  if (const double period = shared.tube.period; period > 0) {
    const int elements = surface::elements_per_period(options, outline.radius(), period, std::min(length, period) / 2);
    if (const double most = most_wall_points() / options.azimuthal_elements; elements > most)
      throw UserError(
          formatted("A period of %.4g needs %d elements along the wall, but at most %.0f fit into memory: give a shorter period.", period,
                    elements, most));
    return std::make_shared<surface::TubeWall>(surface::periodic_tube_wall(outline, options, period, elements, std::min(length, period) / 2));
  }
  const double along = surface::tube_length(shared.tube, outline.radius(), length);
  auto wall = std::make_shared<surface::TubeWall>(surface::tube_wall(outline, options, along, length / 2));
  surface::check_length(*wall, first, last);
  return wall;
}

}  // namespace

std::shared_ptr<const surface::TubeWall> make_wall(const SharedOptions& shared, const Body& body) {
  if (!shared.tube.present) return {};
  switch (shared.tube.kind()) {
    case surface::DuctKind::straight_tube: return make_straight_wall(shared, body);
    case surface::DuctKind::channel: return body.duct->fixed_wall();
  }
  throw std::logic_error("this DuctKind has no wall");
}

std::unique_ptr<coupling::Tube> make_tube(const SharedOptions& shared, const Body& body, Phases& phases) {
  if (!body.wall) return {};
  coupling::TubeParameters parameters;
  parameters.viscosity = shared.flow.viscosity;
  parameters.holds_pressure_drop = shared.flow.held == "pressure drop";
  parameters.quadrature = shared.quadrature;
  parameters.direct = shared.solvers.direct;
  parameters.walls = shared.walls;
  switch (body.wall->kind) {
    case surface::DuctKind::straight_tube: return std::make_unique<coupling::Tube>(*body.wall, *body.duct, body.space, parameters, phases);
    case surface::DuctKind::channel:
      parameters.symmetry = body.symmetry;
      return std::make_unique<coupling::Tube>(std::dynamic_pointer_cast<const coupling::ChannelFlow>(body.duct), body.space, parameters, phases);
  }
  throw std::logic_error("this DuctKind has no Tube");
}

void TubeRow::add_columns(const SharedOptions& shared, Columns& to) const {
  if (!to.when(shared.tube.present)) return;
  constexpr const char *tube = "; in a tube", *channel = "; in a channel";
  const auto add = [&](double value, const char* name, const char* unit, const char* description, const char* where) {
    to.add(value, {name, unit, description, {}, where});
  };
  add(pressure_drop, "disturbed_pressure_drop", "force/length^2",
      "pressure drop in the tube caused by the particles, in addition to the pressure drop of the empty tube (2.7); in a periodic tube, "
      "over one period",
      tube);
  add_gap(gap, to);
  if (to.when(shared.flow.held == "pressure drop"))
    add(flow_rate, "flow_rate", "length^3/time", "flow rate through the tube or channel with the particles in it, if Flow/held is `pressure drop`",
        "; if Flow/held is `pressure drop`");
  if (to.when(shared.tube.channel.has_value())) {
    add(channel_pressure_drop, "channel_pressure_drop", "force/length^2",
        "pressure drop between the ends of the empty channel, at this time (2.30)", channel);
    add(channel_extra_pressure_drop, "channel_extra_pressure_drop", "force/length^2",
        "pressure drop of the empty channel minus the pressure drop of a straight tube of the same length with the cross-section of the inlet",
        channel);
  }
  add(checks.flux, "disturbance_flux", "1",
      "flow rate of the disturbance velocity through the inlet divided by the flow rate of the empty duct; a measure of error that vanishes "
      "in the exact solution (2.14)",
      tube);
  add(checks.force, "force_imbalance", "1",
      "axial force of the disturbance flow on ends, wall and particle, divided by the pressure force of the empty duct over the length R_T "
      "(radius of the circle with the area of the cross-section); a measure of error that vanishes in the exact solution (2.14)",
      tube);
  if (to.when(!shared.domain.present))
    add(checks.cap_velocity, "cap_velocity", "1",
        "largest disturbance velocity on the ends of the computed part of the tube divided by the mean velocity of the empty duct (if "
        "Flow/type is not `duct`: R_C times the rate of the flow or of relaxation); a measure of error that decreases with the length of the "
        "tube",
        tube);
  add(checks.pressure_by_flux, "pressure_drop_by_flux", "force/length^2",
      "pressure drop caused by the particles, computed from the condition that the disturbance has zero flow rate; agrees with "
      "`disturbed_pressure_drop` in the exact solution",
      tube);
  add(checks.pressure_by_force, "pressure_drop_by_force", "force/length^2",
      "pressure drop caused by the particles, computed from the balance of axial forces; agrees with `disturbed_pressure_drop` in the exact "
      "solution",
      tube);
}

TubeRow tube_row(const coupling::Tube& tube, const stokes::AmbientFlow& flow, coupling::Evaluation& e) {
  return with_channel(tube, flow, {.pressure_drop = e.response().pressure_drop, .gap = tube.gap(), .checks = e.checks()});
}

TubeRow tube_row(coupling::Tube& tube, const stokes::AmbientFlow& flow, const Net& density, double pressure_drop) {
  return with_channel(tube, flow,
                      {.pressure_drop = pressure_drop, .gap = tube.gap(), .checks = tube.checks(-density, {}, tube.respond(-density))});
}

void check_spread(const Scene& scene, const surface::TubeWall& wall, const surface::Geometry& geometry, const Net& x) {
  if (surface::properties(wall.kind).fixed || wall.period > 0) return;
  const Eigen::VectorXd x1 = x.col(0).array() - geometry.measures(x).centroid[0];
  // a tube radius R_T must remain between the particles and each end, because the disturbance decays over about R_T
  const double needed = 2 * (x1.cwiseAbs().maxCoeff() + wall.radius());
  if (wall.length() < needed)
    throw RunFailure(
        formatted("%s, from x1 = %.4g to %.4g relative to the centroid: with less than R_T = %.4g left at an end, Tube/length = %.4g is "
                  "too short",
                  scene.particles.size() == 1 ? "the particle has become long" : "the particles have drawn apart", x1.minCoeff(), x1.maxCoeff(),
                  wall.radius(), wall.length()));
}

double least_axial_position(const Scene& scene, const Body& body, const Columns& row) {
  const std::string name = scene.in_system() ? "centroid_x" : "center_x";
  const std::vector<double> x1 = row.of_particles(name + "1"), x2 = row.of_particles(name + "2"), x3 = row.of_particles(name + "3");
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t p = 0; p < x1.size(); ++p) least = std::min(least, body.wall ? body.wall->axial_position({x1[p], x2[p], x3[p]}) : x1[p]);
  return least;
}

std::string nearest_to_wall(const Scene& scene, const Body& body, std::span<const coupling::Particle> particles, const Net& x) {
  const auto distance = [&](const Vec3& at) {
    double least = std::numeric_limits<double>::infinity();
    for (const stokes::PlaneWall& wall : scene.wall.planes()) least = std::min(least, wall.height(at));
    if (!body.wall) return least;
    const auto& channel = body.wall->channel;
    return channel ? channel->outline().distance(channel->coordinates(at).tail<2>()) : body.duct->outline().distance(at.tail<2>());
  };
  const auto gap = [&](const coupling::Particle& one) {
    double least = std::numeric_limits<double>::infinity();
    const auto rows = one.block.rows(x);
    for (Eigen::Index i = 0; i < rows.rows(); ++i) least = std::min(least, distance(rows.row(i).transpose()));
    return least;
  };
  return particles.empty() ? scene.particles.front().path() : std::ranges::min(particles, {}, gap).path;
}

std::string coarse_wall(const SharedOptions& shared, const Body& body, const Columns& row) {
  if (!body.wall) return {};
  const double gap = row.value("gap"), widest = body.wall->widest, time = row.value("time");
  if (gap > 0.6 * widest) return {};
  const std::string list = shared.tube.list(), when = time > 0 && shared.runs_in_time() ? formatted("at time %.4g ", time) : "";
  return when + formatted("the gap to the wall (%.2g) is narrower than 0.6 of the wall's elements (%.2g): set more %s/azimuthal elements and "
                          "%s/axial elements",
                          gap, widest, list.c_str(), list.c_str());
}

}  // namespace tanktread
