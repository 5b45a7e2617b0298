#pragma once

#include <vector>

#include "record/files/arrays.hpp"
#include "stokes/flow/duct_flow.hpp"
#include "system/solids/channel_flow.hpp"

namespace tanktread {

/// The section of a tube and the flow through it, for pictures: the file `duct.h5` of a run's results.
///   outline (M, 2)   places x2, x3 along the outline, counter-clockwise; the first once more at the end
///   x2 (n), x3 (m)   lines of a grid over the section's box
///   velocity (m, n)  v_1 at the grid's points; not a number outside of the section
///   maximum (3)      x2, x3 of the largest velocity, and this velocity
///   pressure_gradient, mean_velocity, radius (R_T)
std::vector<output::Array> duct_picture(const stokes::DuctFlow& flow);

/// A channel and the flow through it without particles, for pictures: the file `channel.h5` of a run's results. Collective.
std::vector<output::Array> channel_picture(const coupling::ChannelFlow& flow);

}  // namespace tanktread
