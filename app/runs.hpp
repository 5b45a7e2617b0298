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
/// Stopped if a stop signal arrives before the first step. Collective.
int simulate(const Scene& scene, const RunRequest& request);

/// Runs the computation that the section Steady, Periodic or Spectrum of the deck requests. Returns and throws like `simulate`. Collective.
int find_steady(const Scene& scene, const RunRequest& request);

/// Throws UserError if find_steady() refuses the scene before its first step, for example because of the parameter of a branch. Does nothing if the
/// scene requests no search. Collective.
void check_search(const Scene& scene, const RunRequest& request);

/// Solves for the traction on a body with prescribed motion. Records one row of the series and one snapshot. Returns the exit code like `simulate`.
/// Collective.
int resist(const Scene& scene, const RunRequest& request);

/// Solves for the flow through a periodic cell that contains plates or posts but no particles. Records one row of the series and one snapshot.
/// Returns the exit code like `simulate`. Collective.
int flow_past_solids(const Scene& scene, const RunRequest& request);

/// Scene, request, ranks and timers, which runs of all kinds have. Begins the set-up. During its lifetime, the program is also to stop after
/// Output/wall-clock limit.
class AnyRun {
 public:
  AnyRun(const AnyRun&) = delete;
  AnyRun& operator=(const AnyRun&) = delete;

 protected:
  AnyRun(const Scene& scene, const RunRequest& request);
  ~AnyRun();

  /// Returns the wall time on this rank since the run began.
  double seconds_here() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }
  bool prints() const { return ranks_.rank() == 0 && !request_.quiet; }  ///< returns whether this rank prints the plan and the progress of the run
  void print(const output::Entries<std::string>& plan) const;            ///< prints the plan of the run

  const Scene& scene_;
  const RunRequest& request_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  Phases phases_ = started();
  std::optional<Phases::Scope> clock_{std::in_place, phases_, "set-up"};  // timer of the phase `set-up`, later of the main phase of the run
  coupling::Ranks ranks_;
};

/// A run that solves one problem without time steps, and records one row of the series and one snapshot. Every call is collective.
class StationaryRun : AnyRun {
 public:
  /// Begins the set-up. Throws UserError if the run is to be resumed. `why`: key of the deck because of which there are no time steps.
  StationaryRun(const Scene& scene, const RunRequest& request, const std::string& why);

  void show(output::Entries<std::string> plan);  ///< prints the plan of the run
  void end_set_up();                             ///< throws Stopped if the program is to stop
  double seconds() const { return ranks_.seconds_since(start_); }  ///< returns the wall time since the run began
  coupling::Ranks& ranks() { return ranks_; }
  Phases& phases() { return phases_; }

  /// Records the row, and the snapshot of the surface body.rest. Adds the plan and `kernel`, the kernel evaluations of all ranks, to `account`,
  /// shows the warnings `remarks`, and closes the results. Returns the exit code like `simulate`.
  int record(const Body& body, Columns& row, const SurfaceSnapshot& snapshot, Account account, const stokes::Evaluations& kernel,
             std::span<const Warning> remarks = {});

 private:
  output::Entries<std::string> plan_;
};

}  // namespace tanktread
