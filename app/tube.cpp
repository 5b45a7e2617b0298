#include "app/tube.hpp"

#include <algorithm>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/words.hpp"
#include "surface/clearance.hpp"
#include "surface/closest_points.hpp"
#include "surface/geometry.hpp"

namespace tanktread {

namespace {

/// In a channel, at the places that a surface is drawn from.
void check_fits_channel(const Scene& scene, const Body& body, const surface::TubeWall& wall) {
  const surface::Channel& channel = *wall.channel;
  const surface::Patches particle(surface::BezierMap(body.space), body.initial), around(surface::BezierMap(wall.space), wall.net);
  double first = channel.end(), last = channel.start();
  for (int e = 0; e < particle.size(); ++e)
    for (const auto& line : surface::sample(particle[e]))
      for (const Vec3& x : line) {
        const Vec3 at = channel.coordinates(x);
        if (!channel.outline().inside(at.tail<2>()))
          throw UserError(formatted("The particle does not fit into the channel: at [%.4g, %.4g, %.4g] it is in the wall; R_C = %.4g, half the "
                                    "channel's width is %.4g where it is narrowest.",
                                    x[0], x[1], x[2], body.radius, channel.smallest_radius()));
        first = std::min(first, at[0]), last = std::max(last, at[0]);
      }
  const double margin = 1.7 * wall.radius();
  if (first < channel.start() + margin || last > channel.end() - margin)
    throw UserError(formatted("The particle, from s = %.4g to %.4g, is too close to an end of the channel: 1.7 R_T = %.4g must be left to "
                              "Channel/start = %.4g and Channel/end = %.4g.",
                              first, last, margin, channel.start(), channel.end()));
  const surface::ElementBoxes its(particle), walls(around);
  const double gap = surface::closest_points(its, walls, 1e-5 * wall.radius(), wall.radius()).gap;
  if (const double least = scene.tube.contact_gap * body.radius; gap < least)
    throw UserError(formatted("The particle starts too close to the channel's wall: the gap is %.4g, less than Channel/contact gap, %g R_C = %.4g.",
                              gap, scene.tube.contact_gap, least));
}

void check_fits(const Scene& scene, const Body& body) {
  if (const auto* channel = dynamic_cast<const coupling::ChannelFlow*>(body.duct.get()))
    return check_fits_channel(scene, body, *channel->surface());
  const surface::Outline& outline = body.duct->outline();
  const Vec3& centre = scene.particle.shape.center;
  const double from_axis = outline.distance({centre[1], centre[2]});
  if (from_axis <= 0)
    throw UserError(
        formatted("Particle/center [%g, %g, %g] is outside of the tube, %g beyond its wall.", centre[0], centre[1], centre[2], -from_axis));
  const surface::Clearance nearest = surface::clearance(surface::Patches(surface::BezierMap(body.space), body.initial), outline);
  const std::string where = formatted("at (x2, x3) = (%.4g, %.4g)", nearest.x[1], nearest.x[2]);
  if (nearest.gap <= 0)
    throw UserError(formatted("The particle does not fit into the tube: %s it reaches %.4g beyond the wall; R_C = %.4g, R_T = %.4g.",
                              where.c_str(), -nearest.gap, body.radius, outline.radius()));
  const double least = scene.tube.contact_gap * body.radius;
  if (nearest.gap < least)
    throw UserError(
        formatted("The particle starts too close to the tube's wall: %s the gap is %.4g, less than Tube/contact gap, %g R_C = %.4g.",
                  where.c_str(), nearest.gap, scene.tube.contact_gap, least));
}

}  // namespace

void check_fit(const Scene& scene, const Body& body) {
  if (!scene.tube.present) return;
  try {
    check_fits(scene, body);
  } catch (const UserError& error) {
    if (scene.name.empty()) throw;
    throw UserError("Particles/" + scene.name + ": " + error.what());
  }
}

std::shared_ptr<const stokes::DuctFlow> duct(const Scene& scene) {
  if (!scene.tube.present) return {};
  if (scene.tube.channel)
    return std::make_shared<const coupling::ChannelFlow>(scene.tube, scene.flow.viscosity, scene.flow.mean_velocity.value_or(1.0), scene.quadrature,
                                                         scene.solvers.wall);
  return std::make_shared<const stokes::DuctFlow>(scene.tube, scene.flow.viscosity, scene.flow.mean_velocity.value_or(1.0));
}

std::shared_ptr<const surface::TubeWall> wall(const Scene& scene, const Body& body) {
  if (!scene.tube.present) return {};
  if (const auto* channel = dynamic_cast<const coupling::ChannelFlow*>(body.duct.get())) return channel->surface();
  const surface::Outline& outline = body.duct->outline();
  const double centroid = surface::measures(body.space, body.rest).centroid[0];
  const Eigen::VectorXd x1 = body.rest.col(0).array() - centroid;
  const double length = x1.maxCoeff() - x1.minCoeff(), period = scene.tube.periodic_length.value_or(0);
  const int images = surface::train_images(scene.tube, outline.radius(), scene.quadrature.tolerance);
  if (images > 0 && period <= length)
    throw UserError(formatted("Tube/periodic length = %.4g must be more than the particles are long, which reach from x1 = %.4g to %.4g seen from "
                              "their centroid.",
                              period, x1.minCoeff(), x1.maxCoeff()));
  surface::TubeOptions options = scene.tube;
  const double chain = length + 2 * images * period, alone = surface::tube_length({}, outline.radius(), length);
  const double along_chain = std::ceil((chain - length) / alone * options.axial_elements), most = most_wall_points() / options.azimuthal_elements;
  if (options.axial_elements + along_chain > most)
    throw UserError(formatted("Tube/periodic length = %.4g with %d copies at either side asks for %.3g elements along the wall, but at most %.0f fit "
                              "into memory: give a shorter one.",
                              period, images, options.axial_elements + along_chain, most));
  options.axial_elements += static_cast<int>(along_chain);
  double along = surface::tube_length(scene.tube, outline.radius(), chain);
  if (images > 0 && options.grading == 1) along = surface::repeat_elements(options, along, period);
  auto wall = std::make_shared<surface::TubeWall>(surface::tube_wall(outline, options, along, chain / 2));
  wall->images = images;
  surface::check_length(*wall, x1.minCoeff() - images * period, x1.maxCoeff() + images * period);
  return wall;
}

std::unique_ptr<coupling::Tube> tube(const Scene& scene, const Body& body, Phases& phases) {
  if (!body.wall) return {};
  coupling::TubeParameters parameters;
  parameters.viscosity = scene.flow.viscosity;
  parameters.viscosity_ratio = scene.particle.viscosity_ratio;
  if (scene.tube.channel) parameters.symmetry = body.symmetry;
  parameters.holds_pressure_drop = scene.flow.held == "pressure drop";
  parameters.period = scene.tube.periodic_length.value_or(0);
  parameters.copies = body.wall->images;
  parameters.quadrature = scene.quadrature;
  parameters.direct = scene.solvers.direct;
  if (const auto channel = std::dynamic_pointer_cast<const coupling::ChannelFlow>(body.duct))
    return std::make_unique<coupling::Tube>(channel, body.space, parameters, phases);
  return std::make_unique<coupling::Tube>(*body.wall, *body.duct, body.space, parameters, phases);
}

void add_tube(coupling::Capsule& capsule, const Net& x, Moment& now) {
  coupling::Tube& tube = *capsule.tube();
  now.tube = capsule.checks(x);
  now.pressure_drop = capsule.response(x).pressure_drop / tube.copies();
  now.gap = tube.gap();
  add_channel(tube, now);
}

void add_tube(coupling::Tube& tube, const Net& density, Moment& now) {
  now.tube = tube.checks(-density, {}, tube.respond(-density));
  add_channel(tube, now);
}

void add_channel(const coupling::Tube& tube, Moment& now) {
  now.flow_rate = tube.flow_rate(now.pressure_drop * tube.copies());
  const auto* channel = dynamic_cast<const coupling::ChannelFlow*>(&tube.flow());
  if (channel) now.channel_pressure_drop = channel->pressure_drop(), now.channel_extra_pressure_drop = channel->extra_pressure_drop();
}

void check_spread(const Scene& scene, const surface::TubeWall& wall, const surface::Geometry& geometry, const Net& x) {
  if (wall.channel || (scene.particles.empty() && !scene.tube.periodic_length)) return;
  const Eigen::VectorXd x1 = x.col(0).array() - geometry.measures(x).centroid[0];
  const double period = scene.tube.periodic_length.value_or(0), chain = wall.images * period;
  if (period > 0 && x1.maxCoeff() - x1.minCoeff() >= period)
    throw RunFailure(formatted("the particles reach from x1 = %.4g to %.4g seen from their centroid, into their copies: Tube/periodic length = %.4g "
                               "is too short",
                               x1.minCoeff(), x1.maxCoeff(), period));
  const double needed = 2 * (x1.cwiseAbs().maxCoeff() + chain + wall.radius());  // nearer to an end the disturbance has not died out
  if (wall.length() < needed)
    throw RunFailure(formatted("the particles have drawn apart, from x1 = %.4g to %.4g seen from their centroid: with less than R_T = %.4g left at "
                               "an end, Tube/length = %.4g is too short",
                               x1.minCoeff(), x1.maxCoeff(), wall.radius(), wall.length()));
}

}  // namespace tanktread
