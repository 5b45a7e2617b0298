#pragma once
// The runs that the program starts after the deck is read.

#include "record/results.hpp"
#include "scene/scene.hpp"

namespace tanktread {

/// Exit code of a run that was stopped. A time-dependent run can be resumed.
constexpr int stopped = 4;

/// Runs the scene to its end. Uses one of the functions below if the deck requests a steady or periodic shape, a spectrum or a prescribed motion, or
/// has no particles; otherwise integrates the motion in time. Returns the exit code: 0 if every expectation is met, 1 if an expectation is missed, or
/// `stopped`. Throws UserError, RunFailure, and motion::Stopped if a stop signal arrives before the first step. Collective.
int simulate(const Scene& scene, const RunRequest& request);

/// Runs the computation that the section Steady, Periodic or Spectrum of the deck requests. Returns and throws like `simulate`. Collective.
int find_steady(const Scene& scene, const RunRequest& request);

/// Solves for the traction on a body with prescribed motion. Records one row of the series and one snapshot. Returns the exit code like `simulate`.
/// Collective.
int resist(const Scene& scene, const RunRequest& request);

/// Solves for the flow through a periodic cell that contains plates or posts but no particles. Records one row of the series and one snapshot.
/// Returns the exit code like `simulate`. Collective.
int flow_past_solids(const Scene& scene, const RunRequest& request);

/// Records the row of the series and the snapshot of a steady problem whose surface is body.rest. Adds `kernel`, the kernel evaluations of all ranks,
/// to the counts in `account`, and closes the results. Returns the exit code like `simulate`. Collective.
int record_steady(const Scene& scene, const RunRequest& request, const Body& body, const coupling::Ranks& ranks, Phases& phases, Columns& row,
                  const SurfaceSnapshot& snapshot, Account account, const stokes::Evaluations& kernel);

}  // namespace tanktread
