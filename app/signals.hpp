#pragma once
// Handling of stop signals.

namespace tanktread {

/// Installs handlers of SIGTERM, SIGINT and SIGHUP, so that the run ends with a checkpoint. The second signal of a kind ends the program immediately.
/// Signals that are ignored, for example by nohup, stay ignored. Writing to a closed pipe or beyond a file size limit becomes an ordinary write
/// error.
void catch_signals();

/// Returns whether this process has received a stop signal.
bool told_to_stop();

/// Throws motion::Stopped on every rank if any rank has received a stop signal. Collective.
void stop_where_told();

}  // namespace tanktread
