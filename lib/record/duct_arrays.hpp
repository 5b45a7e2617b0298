#pragma once
// Arrays of the files `duct.h5` and `channel.h5`: cross-section, wall and flow of an empty tube or channel, for plots.

#include <vector>

#include "record/files/file.hpp"
#include "stokes/flow/duct_flow.hpp"
#include "system/solids/ducts/channel_flow.hpp"

namespace tanktread {

/// Returns the cross-section of a tube and the flow through the empty tube, for plots: the arrays of the file `duct.h5` of a run's results.
///   outline (M, 2)   points x2, x3 along the outline, counter-clockwise; the first is repeated at the end
///   x2 (n), x3 (m)   coordinates of the lines of a grid over the bounding box of the cross-section
///   velocity (m, n)  v_1 at the grid's points; NaN outside of the cross-section
///   maximum (3)      x2, x3 of the largest velocity, and this velocity
///   pressure_gradient, mean_velocity, radius (R_T)
std::vector<output::Array> duct_arrays(const stokes::DuctFlow& flow);

/// Returns the arrays of the file `channel.h5` with their names, units and descriptions, without values.
std::vector<output::Array> described_channel_arrays();

/// Returns the shape of a channel and the flow through the empty channel, for plots: the arrays of the file `channel.h5` of a run's results.
/// Collective.
std::vector<output::Array> channel_arrays(const coupling::ChannelFlow& flow);

}  // namespace tanktread
