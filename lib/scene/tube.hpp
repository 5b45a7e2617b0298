#pragma once
// The tube of a scene: what it is made of, whether the particle fits, and what is recorded in it.

#include <memory>
#include <vector>

#include "scene/body.hpp"
#include "scene/series/diagnostics.hpp"
#include "system/solids/tube.hpp"

namespace tanktread {

/// The duct's own flow; in another one, or in quiescent fluid, that of the mean velocity 1, which the pressure drop (2.7) is told by.
std::shared_ptr<const stokes::DuctFlow> duct(const Scene& scene);

/// Throws UserError, with the numbers, where the scene's particle does not fit into its tube, if there is one.
void check_fit(const Scene& scene, const Body& body);

/// The wall around all that the body is, at rest. Throws UserError, with the numbers, where the tube is too short.
std::shared_ptr<const surface::TubeWall> wall(const Scene& scene, const Body& body);

/// The tube as the body meets it, which is all particles of the scene; nothing without one.
std::unique_ptr<coupling::Tube> tube(const Scene& scene, const Body& body, Phases& phases);

/// Data of the tube for one row. Pressure drops are those of one period of a train.
struct TubeRow {
  double pressure_drop = 0, gap = 0, flow_rate = 0, channel_pressure_drop = 0, channel_extra_pressure_drop = 0;
  coupling::Tube::Checks checks;
  void add_columns(const Scene& scene, Columns& to) const;
};

/// Returns the row's part for the particles at x. Collective.
TubeRow tube_row(const coupling::Tube& tube, coupling::Evaluation& e);

/// Returns it for a rigid body where the tube has it placed, with this force density on the fluid and this pressure drop. Collective.
TubeRow tube_row(coupling::Tube& tube, const Net& density, double pressure_drop);

/// Throws RunFailure where particles at x have drawn apart by more than the wall is long, or are longer than the period of their train.
void check_spread(const Scene& scene, const surface::TubeWall& wall, const surface::Geometry& geometry, const Net& x);

}  // namespace tanktread
