#pragma once
// The tube of a scene: what it is made of, whether the particle fits, and what is recorded in it.

#include <memory>
#include <vector>

#include "app/body.hpp"
#include "app/diagnostics.hpp"
#include "coupling/tube.hpp"

namespace tanktread {

/// The duct's own flow; in quiescent fluid that of the mean velocity 1, which the pressure drop (2.7) is told by.
std::shared_ptr<const stokes::DuctFlow> duct(const Scene& scene);

/// The wall around a particle with control net `rest`. Throws UserError, with the numbers, where the particle does not fit or the tube is too short.
std::shared_ptr<const surface::TubeWall> wall(const Scene& scene, const Body& body);

/// The tube as the particle meets it; nothing without one.
std::unique_ptr<coupling::Tube> tube(const Scene& scene, const Body& body, Phases& phases);

/// Further series of a deformable particle in a tube, and what they are taken from: the particle at x, with the velocity v. Collective.
std::vector<Series> tube_series();
void add_tube(coupling::Capsule& capsule, const Net& x, const Net& v, Moment& now);

/// Lines of the plan.
output::Entries<std::string> tube_plan(const Scene& scene, const Body& body, int ranks);

/// Why a run must end whose particle is at this distance from the wall: closer than `Tube/contact gap`. Empty if it need not.
std::string contact(const Scene& scene, double gap);

}  // namespace tanktread
