#pragma once
// `summary.yaml`: how a run ended, for people and scripts.

#include <string>
#include <utility>
#include <vector>

#include "deck/expectation.hpp"

namespace tanktread::output {

template <class Value>
using Entries = std::vector<std::pair<std::string, Value>>;  ///< in the order in which they are written

struct Summary {
  std::string status = "done";  ///< or `steady`, `stopped: <by what>`, `failed: <reason>`
  Entries<double> final;  ///< last value of every series; steady problems add drag, drag_error, ...
  Entries<std::string> final_in_si;  ///< of those with a dimension, where the deck says what its units are
  Entries<std::vector<double>> final_vectors;  ///< what is a vector, as a list: drag, torque
  std::vector<deck::Verdict> expect;
  Entries<long> counts;       ///< work: steps, evaluations, assemblies, ...
  Entries<double> seconds;    ///< by phase
  Entries<long> memory;       ///< bytes: of the rank with most, of all ranks
  Entries<std::string> plan;  ///< what the run chose to compute, one line each
  Entries<double> numbers;    ///< derived and dimensionless ones of the scene
  Entries<std::string> modes;  ///< of a spectrum, what each mode is
  std::vector<std::string> warnings;  ///< edges of the method that the run came near to, a sentence each
};

/// The text of `summary.yaml`: YAML 1.1, every text in quotes, every double readable to its last bit.
std::string yaml(const Summary& summary);

}  // namespace tanktread::output
