#pragma once
// Results of a ladder (runs on finer and finer levels): results of the finest level, with their estimated errors.

#include <string>
#include <vector>

#include "accuracy/ladder.hpp"
#include "accuracy/outcome.hpp"

namespace tanktread::accuracy {

/// Returns one sentence that compares the estimated error of a series with the error that was requested for it.
std::string sentence(const RequestResult& answer);

/// Status at the end of a ladder.
struct LadderEnd {
  std::string status;  ///< `status` in the summary of the ladder; if empty, the ladder has the status of the finest level
  std::string reason;  ///< reason why a request is not met; empty if all requests are met
};

/// Publishes the results of the finest level in the directory of the ladder. The directory then has the files of this level, with `/error/<series>`
/// in `run.h5`, the field `position error` in snapshots if there are at least three levels and obstacle() reports nothing, and the sections `error`,
/// `accuracy` and `expect` in `summary.yaml`. `seconds`: wall seconds of all runs. Prints the warnings of the finest level, and a warning for each
/// missed expectation that has the key `not binding`. Returns one line that lists all other missed expectations; empty if there are none. Serial.
std::string publish(const LadderRequest& task, const std::vector<Outcome>& levels, const std::vector<RequestResult>& answers,
                    const std::vector<SeriesError>& errors, const LadderEnd& end, double seconds);

}  // namespace tanktread::accuracy
