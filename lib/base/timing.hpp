#pragma once
// Where the time goes: named timers that add up, for the closing table and for `seconds` of the summary.

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

namespace tanktread {

/// Seconds and calls of the phases of a run, in the order in which they were first entered.
///
/// A scope that opens inside another one pauses it, so no second is counted twice and the phases add up to the time spent in any.
/// One thread, scopes closed in the reverse order of opening.
class Phases {
 public:
  struct Phase {
    std::string name;
    double seconds = 0;  ///< wall clock, inner phases not included
    long calls = 0;
  };

  using Clock = std::chrono::steady_clock;

  /// Runs the clock of one phase for as long as it lives, or from an earlier time when no other was running.
  class [[nodiscard]] Scope {
   public:
    Scope(Phases& phases, std::string_view name) : phases_(phases) { phases_.enter(name); }
    Scope(Phases& phases, std::string_view name, Clock::time_point since) : Scope(phases, name) { phases_.since_ = since; }
    ~Scope() { phases_.leave(); }
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

   private:
    Phases& phases_;
  };

  /// `auto clock = phases.time("far field");`
  Scope time(std::string_view name) { return Scope(*this, name); }

  const std::vector<Phase>& all() const { return phases_; }
  double seconds(std::string_view name) const;  ///< 0 for a phase that never ran; a running one counts up to its last pause
  double total() const;                         ///< sum over the phases

 private:
  void enter(std::string_view name);
  void leave();
  void charge();

  std::vector<Phase> phases_;
  std::vector<std::size_t> open_;  // positions in phases_, innermost last
  Clock::time_point since_;
};

/// Phases of a run: the first one, `start`, holds what has passed since the program was started, but for the loading of libraries.
Phases started();

}  // namespace tanktread
