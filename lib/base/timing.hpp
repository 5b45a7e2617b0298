#pragma once
// Named timers of the phases of a run, for the table that is printed at the end of the run and for `seconds` in the summary.

#include <chrono>
#include <string>
#include <string_view>
#include <vector>

namespace tanktread {

/// Seconds and calls of the phases of a run, in the order in which they were first entered.
///
/// A scope that opens inside another scope pauses the outer one. Therefore no time is counted twice, and the sum over the phases is the total time in
/// which any scope was open. All scopes must be in one thread and close in the reverse order of opening.
class Phases {
 public:
  struct Phase {
    std::string name;
    double seconds = 0;  ///< wall-clock time of the phase, without phases that ran inside it
    long calls = 0;
  };

  using Clock = std::chrono::steady_clock;

  /// Runs the clock of one phase during its lifetime. If `since` is given, the time of the phase counts from this earlier time, and no other phase
  /// may have run since then.
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

  /// Returns a scope that times a phase: `auto clock = phases.time("far field");`
  Scope time(std::string_view name) { return Scope(*this, name); }

  const std::vector<Phase>& all() const { return phases_; }
  double seconds(std::string_view name) const;  ///< wall seconds of a phase up to its last end or pause; 0 if it never ran
  double total() const;                         ///< returns the sum over the phases

 private:
  void enter(std::string_view name);
  void leave();
  void charge();

  std::vector<Phase> phases_;
  std::vector<std::size_t> open_;  // indices in phases_ of the open scopes, innermost last
  Clock::time_point since_;
};

/// Returns the phases of a run with a first phase `start`: the time since the program was started, without the loading of libraries.
Phases started();

}  // namespace tanktread
