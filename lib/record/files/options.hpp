#pragma once
// Options of the results: the section `Output` of the deck.

#include <optional>
#include <string>

#include "base/timing.hpp"
#include "base/types.hpp"
#include "deck/forward.hpp"

namespace tanktread::output {

/// Options of the results: `Output/*` of the deck.
struct Options {
  std::optional<double> interval;          ///< simulated time between snapshots; empty: a twentieth of the final time
  std::optional<std::string> between_steps;  ///< `land`: steps end at snapshots; `interpolate`: snapshots interpolate between steps; empty:
                                             ///< `interpolate` with fixed time step and fixed mesh, otherwise `land`
  std::optional<double> wall_clock_limit;  ///< seconds of real time after which the run stops with a checkpoint; empty: no limit

  bool power_balance = false;              ///< true if each row of the series holds the power balance
  std::optional<Vec3> view;                ///< direction in which the outlines of particles are measured, of any length; empty: no such series
  bool surface_text = false;               ///< true if the final surface is written as Bezier-extraction text, `surface.iga`

  /// Reduces `wall_clock_limit` by the seconds since `start`, and to at most `most`, for one of several runs that have the limit in common.
  void limit(Phases::Clock::time_point start, std::optional<double> most);
  /// Returns true if a run that has taken this many seconds of real time has passed `wall_clock_limit`.
  bool too_late(double seconds) const { return wall_clock_limit && seconds > *wall_clock_limit; }

  void declare(deck::Section& section);
};

}  // namespace tanktread::output
