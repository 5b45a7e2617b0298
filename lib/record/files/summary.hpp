#pragma once
// `summary.yaml`: how a run ended, for people and scripts. Accuracy ladders (lib/accuracy) change summaries as text.

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/types.hpp"
#include "deck/expectation.hpp"

namespace tanktread::output {

template <class Value>
using Entries = std::vector<std::pair<std::string, Value>>;  ///< named values, in the order in which they are written

/// Values of `status` in a summary. done: the run has reached its final time, or found the shape or flow that the deck requests. steady: the shape
/// has become steady. past: all particles have passed the position `Time/end when past`. by_signal, by_clock: the run was stopped by a signal, or at
/// its wall-clock limit. failed: start of the status of a run that failed; the reason follows.
namespace run_status {
inline constexpr const char *done = "done", *steady = "steady", *past = "past";
inline constexpr const char *by_signal = "stopped: by a signal", *by_clock = "stopped: at the wall-clock limit", *failed = "failed: ";
}  // namespace run_status

/// Returns whether a run with this status has reached its end: `done`, `steady` or `past`.
bool reached_end(std::string_view status);

struct Summary {
  std::string status = run_status::done;  ///< one of the values in the namespace `run_status`
  Entries<double> final;  ///< last value of every series; steady problems add values such as drag and drag_error
  Entries<std::string> final_in_si;  ///< last values of series with a physical unit, in SI units; empty if the deck does not set its units
  Entries<Vec3> final_vectors;  ///< last values of vectors, as lists: drag, torque
  std::vector<deck::Verdict> expect;
  Entries<long> counts;       ///< work: steps, evaluations, assemblies, ...
  Entries<double> seconds;    ///< wall time by phase
  Entries<long> memory;       ///< peak memory in bytes: the largest of any rank, and the sum of all ranks
  Entries<std::string> plan;  ///< plan of the run: methods and sizes that it chose, one line each
  Entries<double> numbers;    ///< derived and dimensionless numbers of the scene
  Entries<std::string> errors;  ///< error estimates of a run without the section Accuracy, one line each
  Entries<std::string> modes;  ///< kind of each mode of a spectrum
  std::vector<std::string> warnings;  ///< warnings about limits of the method that the run came close to
  std::vector<std::string> obstacles;  ///< reasons, as clauses, why no error of the run can be estimated
};

/// Returns the section `expect` of the summary. `estimates`: estimated error of the series of each expectation; if empty, none is written.
std::string yaml(const std::vector<deck::Verdict>& verdicts, const std::vector<double>& estimates = {});

/// Returns the line `status` of the summary.
std::string yaml_status(const std::string& status);

/// Returns the texts in a list of texts, such as `warnings`, of a summary; none if the summary has no such list.
std::vector<std::string> listed(const std::string& summary, const std::string& name);

/// Returns the status in a summary, without quotes; empty if the summary has none.
std::string status_of(const std::string& summary);

/// Returns the summary with the entry `name` and the indented lines that belong to it replaced by the lines `entry`, each of which ends with a line
/// break. If the summary has no such entry, appends `entry`. An empty `entry` removes the entry.
std::string with_entry(std::string summary, const std::string& name, const std::string& entry);

/// Returns the text of `summary.yaml`: YAML 1.1, every text in quotes, every double with enough digits to be read back exactly.
std::string yaml(const Summary& summary);

}  // namespace tanktread::output
