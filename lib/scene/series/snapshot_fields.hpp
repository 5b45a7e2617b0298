#pragma once
// Fields of a snapshot that follow from the shapes of all particles, their load and their velocity.

#include <span>
#include <vector>

#include "record/files/nodes.hpp"
#include "record/files/snapshot.hpp"
#include "scene/member.hpp"
#include "stokes/kernels/kernels.hpp"

namespace tanktread {

/// Returns load, traction, displacement, velocity, tensions and mean curvature at the nodes, and for several particles their number. `all`: the body
/// of all members; x, load and velocity (of the fluids, or empty): control values of all. Serial.
std::vector<output::Field> snapshot_fields(std::span<const Member> members, const Body& all, const output::Nodes& nodes, const Net& x,
                                           const Net& load, const Net& velocity);

/// Returns, at each node, the displacement that moves its particle into the cell around the origin.
output::Rows into_cell(std::span<const Member> members, const stokes::PeriodicCell& cell, const output::Nodes& nodes, const Net& x);

}  // namespace tanktread
