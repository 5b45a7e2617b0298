#pragma once
// Progress bar of a run, and the table at its end.

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>

#include "base/timing.hpp"
#include "record/files/summary.hpp"

namespace tanktread::output {

/// Data of a finished step.
struct Moment {
  double time = 0;  ///< simulated time
  int step = 0;
  int iterations = 0;      ///< nonlinear iterations of the step
  double deformation = 0;  ///< Taylor parameter D (taylor_inertia)
};

/// Progress display. On a terminal it is a bar that is redrawn in place. Otherwise a plain line is printed when a minute has passed since the last
/// line, or when at least 3 seconds and 5 % of the run have passed since then. If `quiet`, nothing is shown.
class Progress {
 public:
  Progress(double begin, double end, bool quiet, std::FILE* out = stderr);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(const Moment& moment);
  void close();  ///< shows the last step and ends the line of the display; called by the destructor

 private:
  using Clock = std::chrono::steady_clock;
  bool due(const Moment& moment, double now) const;
  void print(const Moment& moment, double now);

  double begin_, end_;
  enum class Manner { silent, lines, bar } manner_;
  std::FILE* out_;
  Clock::time_point start_ = Clock::now();
  Moment last_, printed_;
  double printed_at_ = -1e9;  // seconds since start_
  bool pending_ = false, open_ = false;
};

/// Returns the line for a step, without line end, with a bar of `bar` characters. `seconds`: wall time since the run began (or was resumed) at
/// simulated time `begin`. Example: "[###-----]  45 %  t 3.375/7.5  step 24  9 iterations  D 0.3987  12 s left".
std::string progress_line(const Moment& moment, double begin, double end, double seconds, int bar);

/// Returns a duration as text: "0.8 s", "42 s", "3 min 08 s", "2 h 05 min".
std::string duration(double seconds);

/// Returns the closing table: seconds and share of each phase, work counts, and the directory of the results.
std::string closing_table(const Phases& phases, const Entries<long>& counts, const std::filesystem::path& results);

}  // namespace tanktread::output
