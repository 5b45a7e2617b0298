#pragma once
// The run itself: what main calls once the deck is read.

#include "record/results.hpp"
#include "scene/scene.hpp"

namespace tanktread {

/// Exit code of a run that was stopped and can be resumed.
constexpr int stopped = 4;

/// Runs the scene to its end. Exit code: 0 every expectation met, 1 one was missed, or `stopped`. Throws UserError, RunFailure, and motion::Stopped
/// where the run is told to stop before its first step. Collective.
int simulate(const Scene& scene, const RunRequest& request);

}  // namespace tanktread
