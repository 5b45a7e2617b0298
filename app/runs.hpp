#pragma once
// The runs that the program starts after the deck is read.

#include <chrono>
#include <optional>
#include <string>

#include "record/results.hpp"
#include "scene/scene.hpp"

namespace tanktread {

/// Runs the scene to its end. Uses one of the functions below if the deck requests a steady or periodic shape, a spectrum or a prescribed motion, or
/// has no particles; otherwise integrates the motion in time. Returns Exit::done, Exit::missed or Exit::stopped. Throws UserError, RunFailure, and
/// motion::Stopped if a stop signal arrives before the first step. Collective.
int simulate(const Scene& scene, const RunRequest& request);

/// Runs the computation that the section Steady, Periodic or Spectrum of the deck requests. Returns and throws like `simulate`. Collective.
int find_steady(const Scene& scene, const RunRequest& request);

/// Solves for the traction on a body with prescribed motion. Records one row of the series and one snapshot. Returns the exit code like `simulate`.
/// Collective.
int resist(const Scene& scene, const RunRequest& request);

/// Solves for the flow through a periodic cell that contains plates or posts but no particles. Records one row of the series and one snapshot.
/// Returns the exit code like `simulate`. Collective.
int flow_past_solids(const Scene& scene, const RunRequest& request);

/// A run that solves one problem without time steps, and records one row of the series and one snapshot. Every call is collective.
class StationaryRun {
 public:
  /// Begins the set-up. Throws UserError if the run is to be resumed. `why`: key of the deck because of which there are no time steps.
  StationaryRun(const Scene& scene, const RunRequest& request, const std::string& why);

  void show(output::Entries<std::string> plan);  ///< prints the plan of the run
  void end_set_up();  ///< throws motion::Stopped if a stop signal has arrived or the wall-clock limit has passed
  double seconds() const { return ranks.seconds_since(start_); }  ///< returns the wall time since the run began

  /// Records the row, and the snapshot of the surface body.rest. Adds the plan and `kernel`, the kernel evaluations of all ranks, to `account`,
  /// shows the warnings `remarks`, and closes the results. Returns the exit code like `simulate`.
  int record(const Body& body, Columns& row, const SurfaceSnapshot& snapshot, Account account, const stokes::Evaluations& kernel,
             std::span<const Warning> remarks = {});

  coupling::Ranks ranks;
  Phases phases = started();

 private:
  const Scene& scene_;
  const RunRequest& request_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  std::optional<Phases::Scope> set_up_{std::in_place, phases, "set-up"};
  output::Entries<std::string> plan_;
};

}  // namespace tanktread
