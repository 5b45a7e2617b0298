#pragma once
// Data about the surroundings of a coupled system of particles (tube, cell, walls, posts, gaps) for a row of the results.

#include <vector>

#include "base/columns.hpp"
#include "scene/member.hpp"
#include "system/capsule.hpp"
#include "system/evaluation.hpp"

namespace tanktread {

/// Adds to `row` the columns that describe the surroundings (tube, cell, walls, posts, gaps) of the particles in the shape here.x(). `all`: body of
/// all members. `stresslet`: sum of the stresslets of all members. Throws RunFailure if the particles have spread too far in a tube. Collective.
void add_surroundings(const Scene& scene, const std::vector<Member>& members, const Body& all, coupling::Capsule& capsule, coupling::Evaluation& here,
                      const Mat3& stresslet, const coupling::Ranks& ranks, Columns& row);

}  // namespace tanktread
