#pragma once
// The runs that main starts once the deck is read.

#include "record/results.hpp"
#include "scene/scene.hpp"

namespace tanktread {

/// Exit code of a run that was stopped and can be resumed.
constexpr int stopped = 4;

/// Runs the scene to its end, by one of the functions below if it is not a run in time. Exit code: 0 every expectation met, 1 one was missed, or
/// `stopped`. Throws UserError, RunFailure, and motion::Stopped where the run is told to stop before its first step. Collective.
int simulate(const Scene& scene, const RunRequest& request);

/// Does what Steady, Periodic or Spectrum ask for. Exit code and errors as of `simulate`. Collective.
int find_steady(const Scene& scene, const RunRequest& request);

/// Solves for the traction on a body that moves as the deck says; records one row and one snapshot. Exit code as of `simulate`. Collective.
int resist(const Scene& scene, const RunRequest& request);

}  // namespace tanktread
