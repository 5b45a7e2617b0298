#pragma once
// Lines of the plan about the particles.

#include <string>
#include <vector>

#include "record/files/summary.hpp"
#include "scene/scene.hpp"

namespace tanktread {

/// Unknowns of the equations that are solved for each velocity of a scene (coupling::System).
struct VelocityUnknowns {
  bool deforms = false, bodies = false;  ///< whether there are deformable particles and rigid bodies
  bool tractions = false;                ///< whether the unknowns of rigid bodies are their tractions
  bool walls = false;                    ///< whether the wall traction and the pressure drop of a tube are unknowns
  bool multipliers = false;              ///< whether the multipliers of the volumes are unknowns
  bool system = false;                   ///< whether the velocities of deformable particles are unknowns of a linear system
  bool iterates = false;                 ///< whether there is a linear system for velocities or tractions that is solved by iteration
};

/// Returns the unknowns of a scene with the particles `alone`.
VelocityUnknowns velocity_unknowns(const Scene& scene, const std::vector<ParticleScene>& alone);

/// Returns true if the deck gives a force, a torque or a weight of the particle.
bool has_given_forces(const ParticleScene& particle_scene);

/// Adds the lines about all particles to the plan. A single particle has several lines. If there are several particles, the lines of each are joined
/// into one, and consecutive particles with equal lines share one line. `n_points`: number of control points of all particles. `tree`: true if
/// far-field sums use clusters.
void add_particles(output::Entries<std::string>& lines, const std::vector<ParticleScene>& alone, const VelocityUnknowns& unknowns, int n_points,
                   bool tree);

}  // namespace tanktread
