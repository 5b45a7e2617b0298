#pragma once
// Exit codes of the program.

namespace tanktread {

/// Exit codes of the program, of its runs and of accuracy ladders. done: the run has ended, and all requests and all binding expectations are met.
/// missed: an expectation is missed, or a requested accuracy is not reached. mistake: the deck or the command line is wrong. failed: the run failed.
/// stopped: the run was stopped by a signal or at its wall-clock limit; a time-dependent run can be resumed.
struct Exit {
  enum Code { done = 0, missed = 1, mistake = 2, failed = 3, stopped = 4 };
};

}  // namespace tanktread
