#pragma once
// What a run says while it runs, and when it is done.

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <string>

#include "base/timing.hpp"
#include "record/files/summary.hpp"

namespace tanktread::output {

/// One finished step.
struct Moment {
  double time = 0;  ///< simulated
  int step = 0;
  int iterations = 0;      ///< of the step's solver
  double deformation = 0;  ///< taylor_inertia
};

/// A bar that is drawn over itself where `out` is a terminal; elsewhere one plain line at most every 3 seconds, and then only after
/// another 5 % of the run or a minute; nothing when quiet.
class Progress {
 public:
  Progress(double begin, double end, bool quiet, std::FILE* out = stderr);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  void show(const Moment& moment);
  void close();  ///< draws the last moment and leaves its line; also on destruction

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

/// The line of a moment, `seconds` after the run began (or was resumed) at simulated time `begin`, without line end, with a bar of so
/// many characters: "[###-----]  45 %  t 3.375/7.5  step 24  9 iterations  D 0.3987  12 s left".
std::string progress_line(const Moment& moment, double begin, double end, double seconds, int bar);

/// "0.8 s", "42 s", "3 min 08 s", "2 h 05 min".
std::string duration(double seconds);

/// The closing table: seconds and share of each phase, work counts, where the results are.
std::string closing_table(const Phases& phases, const Entries<long>& counts, const std::filesystem::path& results);

}  // namespace tanktread::output
