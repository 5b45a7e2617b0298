#pragma once
// Results of a ladder (runs on finer and finer levels): results of the finest level, with their estimated errors.

#include <string>
#include <vector>

#include "accuracy/ladder.hpp"
#include "accuracy/outcome.hpp"

namespace tanktread::accuracy {

/// Returns one sentence about a request and its estimate.
std::string sentence(const Answer& answer);

/// Makes the results of the finest level the results in the directory of the ladder: its files, with `/error/<series>` in `run.h5`, the field
/// `position error` in snapshots, and the sections `error`, `accuracy` and `expect` in `summary.yaml`. `why` is the reason for which
/// the ladder has ended without meeting all requests, or empty. Returns the binding expectations that were missed, in one line. Serial.
std::string publish(const Task& task, const std::vector<Outcome>& levels, const std::vector<Answer>& answers, const std::vector<SeriesError>& errors,
                    const std::string& why, double seconds);

}  // namespace tanktread::accuracy
