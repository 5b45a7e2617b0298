#pragma once
// `summary.yaml`: how a run ended, for people and scripts.

#include <string>
#include <utility>
#include <vector>

#include "deck/expectation.hpp"

namespace tanktread::output {

template <class Value>
using Entries = std::vector<std::pair<std::string, Value>>;  ///< named values, in the order in which they are written

struct Summary {
  std::string status = "done";  ///< `done`, `steady`, `stopped: <by what>` or `failed: <reason>`
  Entries<double> final;  ///< last value of every series; steady problems add values such as drag and drag_error
  Entries<std::string> final_in_si;  ///< last values of series with a physical unit, in SI units; empty if the deck does not set its units
  Entries<std::vector<double>> final_vectors;  ///< last values of vectors, as lists: drag, torque
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

/// Returns the texts in a list of texts, such as `warnings`, of a summary; none if the summary has no such list.
std::vector<std::string> listed(const std::string& summary, const std::string& name);

/// Returns the text of `summary.yaml`: YAML 1.1, every text in quotes, every double with enough digits to be read back exactly.
std::string yaml(const Summary& summary);

}  // namespace tanktread::output
