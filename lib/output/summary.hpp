#pragma once
// `summary.yaml`: how a run ended, for people and scripts.

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace tanktread::output {

/// One expected result of the deck and what became of it.
struct Expected {
  std::string name;
  double value = 0;     ///< computed
  double expected = 0;  ///< the deck's
  double error = 0;     ///< absolute, or relative where the deck says so
  bool passed = false;
  std::string not_binding = {};  ///< why a miss did not fail the run; empty: it did
};

template <class Value>
using Entries = std::vector<std::pair<std::string, Value>>;  ///< in the order in which they are written

struct Summary {
  std::string status = "done";  ///< or `steady`, `stopped: <by what>`, `failed: <reason>`
  Entries<double> final;  ///< last value of every series; steady problems add drag, drag_error, ...
  Entries<std::vector<double>> final_vectors;  ///< what is a vector, as a list: drag, torque
  std::vector<Expected> expect;
  Entries<long> counts;       ///< work: steps, evaluations, assemblies, ...
  Entries<double> seconds;    ///< by phase
  Entries<std::string> plan;  ///< what the run chose to compute, one line each
  Entries<double> numbers;    ///< derived and dimensionless ones of the scene
  std::vector<std::string> warnings;  ///< edges of the method that the run came near to, a sentence each
};

/// The text of `summary.yaml`: YAML 1.1, every text in quotes, every double readable to its last bit.
std::string yaml(const Summary& summary);

/// Writes it whole. Throws RunFailure when the disk refuses.
void write_summary(const std::filesystem::path& path, const Summary& summary);

}  // namespace tanktread::output
