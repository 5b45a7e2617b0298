#pragma once
// Rigid motions that a steady search leaves free.

#include <vector>

#include "app/scene.hpp"
#include "coupling/rigid_motion.hpp"
#include "stokes/ambient_flow.hpp"

namespace tanktread {

/// The rigid motions about the origin that change neither the flow nor the weights, patch forces and walls: the Lie derivative of the flow along
/// them is 0, and no force of any particle turns. `size`: a length of the particles, R_C. Q of (4.17) projects onto them.
std::vector<coupling::RigidMotion> free_motions(const Scene& scene, const stokes::AmbientFlow& flow, double size);

}  // namespace tanktread
