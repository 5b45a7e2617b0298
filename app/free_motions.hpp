#pragma once
// Parameters of a steady search that follow from the scene: free rigid motions and the step of the iteration.

#include <vector>

#include "app/scene.hpp"
#include "coupling/rigid_motion.hpp"
#include "stokes/ambient_flow.hpp"

namespace tanktread {

/// The rigid motions about the origin that change neither the flow nor the weights, patch forces and walls: the Lie derivative of the flow along
/// them is 0, and no force of any particle turns. `size`: a length of the particles, R_C. Q of (4.17) projects onto them.
std::vector<coupling::RigidMotion> free_motions(const Scene& scene, const stokes::AmbientFlow& flow, double size);

/// Returns Steady/step, or its default. The default is bounded by the relaxation times of the membranes because the iteration amplifies errors of the
/// velocity in motions that no membrane opposes by the step over these times.
double steady_step(const Scene& scene);

}  // namespace tanktread
