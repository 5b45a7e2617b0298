#pragma once
// Lines of the plan about the particles.

#include <string>
#include <vector>

#include "record/files/summary.hpp"
#include "scene/scene.hpp"

namespace tanktread {

/// Adds the lines about all particles to the plan. A single particle has several lines. If there are several particles, the lines of each are joined
/// into one, and consecutive particles with equal lines share one line. `n_points`: number of control points of all particles. `tree`: true if
/// far-field sums use clusters.
void add_particles(output::Entries<std::string>& lines, const std::vector<ParticleScene>& alone, int n_points, bool tree);

}  // namespace tanktread
