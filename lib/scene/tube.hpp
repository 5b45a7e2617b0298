#pragma once
// Tube of a scene: construction, checks that the particle fits, and recorded data.

#include <memory>
#include <span>
#include <string>

#include "scene/body.hpp"
#include "scene/series/diagnostics.hpp"
#include "system/solids/ducts/tube.hpp"

namespace tanktread {

/// Returns the flow of the empty tube or channel. If Flow/type is not `duct`, the returned flow has the mean velocity R_C times
/// ParticleScene::rate() and only serves to compute the pressure drop (2.7). Returns null if there is no tube.
std::shared_ptr<const stokes::DuctFlow> make_duct(const ParticleScene& particle_scene);

/// Adds to `to` the combinations of keys that are not allowed with a tube or channel.
void reject_with_tube(const ParticleScene& particle_scene, Rejections& to);

/// If the scene has a tube and the particle does not fit into it, throws NoRoom with the lengths concerned.
void check_fit(const ParticleScene& particle_scene, const Body& body);

/// Returns the section of the particle with the control point that is nearest to the walls of the scene, for messages. `x`: net of all particles.
/// `particles`: empty for a lone body.
std::string nearest_to_wall(const Scene& scene, const Body& body, std::span<const coupling::Particle> particles, const Net& x);

/// Returns the wall around the resting shapes of all particles in `body`. Throws UserError, with the lengths, if the tube is too short for the
/// particles or its period is too long.
std::shared_ptr<const surface::TubeWall> make_wall(const SharedOptions& shared, const Body& body);

/// Returns the tube around `body`, which represents all particles of the scene; null if there is no tube.
std::unique_ptr<coupling::Tube> make_tube(const SharedOptions& shared, const Body& body, Phases& phases);

/// Data of the tube for one row of the results. For a periodic train, pressure drops refer to one period.
struct TubeRow {
  double pressure_drop = not_set, gap = not_set, flow_rate = not_set, channel_pressure_drop = not_set, channel_extra_pressure_drop = not_set;
  coupling::Tube::Checks checks;
  void add_columns(const SharedOptions& shared, Columns& to) const;
};

/// Returns the data of the tube (pressure drop, gap) for the particle shapes of the evaluation `e`. `flow`: ambient flow at the time of the
/// row. Collective.
TubeRow tube_row(const coupling::Tube& tube, const stokes::AmbientFlow& flow, coupling::Evaluation& e);

/// Returns the data of the tube (pressure drop, gap) for a rigid body at the position last set in `tube`, from the force density on the fluid and the
/// pressure drop. Collective.
TubeRow tube_row(coupling::Tube& tube, const stokes::AmbientFlow& flow, const Net& density, double pressure_drop);

/// Returns the smallest axial coordinate among the particles' centroids in a row of the results: x1, or in a channel the coordinate along the centre
/// line.
double least_axial_position(const Scene& scene, const Body& body, const Columns& row);

/// Returns a warning if the gap to the wall in a row of the results is smaller than 0.6 of the size of the widest wall element, because the error of
/// the wall traction then exceeds 1e-4. Otherwise, and without a tube, returns an empty text.
std::string coarse_wall(const SharedOptions& shared, const Body& body, const Columns& row);

/// Throws RunFailure if the modelled part of the tube is too short for the shape x, because particles have moved apart or become long. Does nothing
/// in a channel or in a periodic tube.
void check_spread(const Scene& scene, const surface::TubeWall& wall, const surface::Geometry& geometry, const Net& x);

}  // namespace tanktread
