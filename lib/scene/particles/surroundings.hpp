#pragma once
// Data about the surroundings of a coupled system of particles (tube, cell, walls, posts, gaps) for a row of the results.

#include <vector>

#include "scene/member.hpp"
#include "scene/series/run_row.hpp"
#include "system/capsule.hpp"
#include "system/evaluation.hpp"

namespace tanktread {

/// Sets in `row` the members that describe the surroundings (tube, cell, walls, posts, gaps) of the particles in the shape here.x(). `row.together`
/// must be set. `all`: body of all members. Throws RunFailure if the particles have spread too far in a tube. Collective.
void set_surroundings(const Scene& scene, const std::vector<Member>& members, const Body& all, coupling::Capsule& capsule, coupling::Evaluation& here,
                      const coupling::Ranks& ranks, RunRow& row);

}  // namespace tanktread
