#pragma once
// Handling of stop signals, and reasons for which runs are stopped.

#include <string>

namespace tanktread {

/// Installs handlers of SIGTERM, SIGINT and SIGHUP, so that the run ends with a checkpoint. The second signal of a kind ends the program immediately.
/// Signals that are ignored, for example by nohup, stay ignored. Writing to a closed pipe or beyond a file size limit becomes an ordinary write
/// error.
void catch_signals();

/// Returns whether this process has received a stop signal.
bool stop_requested();

/// Throws motion::Stopped on every rank if any rank has received a stop signal or passes `too_late` = true (wall-clock limit exceeded). Collective.
void stop_where_told(bool too_late = false);

/// Reasons for which a run is stopped, as written to `status` of the summary.
inline const std::string by_signal = "stopped: by a signal", by_clock = "stopped: at the wall-clock limit";

/// Returns the reason why all ranks have thrown motion::Stopped: `by_signal` if any rank has received a stop signal, otherwise `by_clock`.
/// Collective.
std::string reason_of_stop();

/// Returns a status without its colon, for use within a message.
std::string spoken(std::string status);

}  // namespace tanktread
