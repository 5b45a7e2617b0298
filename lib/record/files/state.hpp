#pragma once
// The state of a time integrator as part of a checkpoint.

#include "motion/integrator.hpp"
#include "record/files/checkpoint.hpp"

namespace tanktread::output {

/// Adds all of `state` to the checkpoint: number "time" among others.
void store(const motion::State& state, Checkpoint& checkpoint);

/// The same state, to the last bit. Throws std::out_of_range where the checkpoint holds none.
motion::State stored_state(const Checkpoint& checkpoint);

/// Whether all ranks hold the same state, to the last bit. Collective.
bool equal_on_all_ranks(const motion::State& state);

}  // namespace tanktread::output
