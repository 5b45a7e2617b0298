#pragma once
// Signals to end, from the start of the program on.

namespace tanktread {

/// From now on SIGTERM, SIGINT and SIGHUP are noted, for the run to end with a checkpoint; the second of a kind ends the program at once. What is
/// ignored stays so (nohup). To write into a closed pipe or beyond the limit of a file is an error like any other of writing.
void catch_signals();

/// Whether this process was told to stop.
bool told_to_stop();

/// Throws motion::Stopped on every rank when one was told to stop. Collective.
void stop_where_told();

}  // namespace tanktread
