#pragma once

#include <vector>

#include "coupling/channel_flow.hpp"
#include "output/arrays.hpp"

namespace tanktread {

/// A channel and the flow through it without particles, for pictures: the file `channel.h5` of a run's results. Collective.
std::vector<output::Array> channel_picture(const coupling::ChannelFlow& flow);

}  // namespace tanktread
