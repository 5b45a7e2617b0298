#pragma once
// Handling of stop signals, and reasons for which runs are stopped.

#include <string>

namespace tanktread {

/// Installs handlers of SIGTERM, SIGINT and SIGHUP, which then are stop requests (base/stop.hpp). The second signal of a kind ends the program
/// immediately. Signals that are ignored, for example by nohup, stay ignored. Writing to a closed pipe or beyond a file size limit becomes an
/// ordinary write error.
void catch_signals();

/// Returns whether this process has received a stop signal.
bool stop_signal_received();

/// Returns the status of a run after all ranks have thrown Stopped: run_status::by_signal (record/files/summary.hpp) if any rank has received
/// a stop signal, otherwise run_status::by_clock. Collective.
std::string reason_of_stop();

/// Returns a status without its colon, for use within a message.
std::string spoken(std::string status);

}  // namespace tanktread
