#pragma once
// The run itself: what main calls once the deck is read.

#include <string>
#include <vector>

#include "app/scene.hpp"
#include "output/summary.hpp"

namespace tanktread {

/// What the command line says beside the deck.
struct RunRequest {
  std::string output;           ///< directory of the results
  bool resume = false;          ///< go on from the newest checkpoint there
  bool overwrite = false;       ///< delete the results of an earlier run there
  bool another_scheme = false;  ///< than the checkpoint's, of whose memory only shape, slope and step mean something to it
  bool quiet = false;           ///< no progress bar
  std::string deck_text;        ///< the effective deck, to be stored with the results
};

/// What of `Expect` is missed whatever the run finds: a sentence for each time that it does not reach. Throws UserError where a series is expected
/// that the scene does not record.
std::vector<std::string> check_expectations(const Scene& scene);

/// Exit code of a run that was stopped and can be resumed.
constexpr int stopped = 4;

/// Runs the scene to its end. Exit code: 0 every expectation met, 1 one was missed, or `stopped`. Throws UserError, RunFailure, and motion::Stopped
/// where the run is told to stop before its first step. Collective.
int simulate(const Scene& scene, const RunRequest& request);

/// The effective deck that the newest checkpoint of a directory holds. Throws as newest_checkpoint does. Collective.
std::string stored_deck(const std::string& directory);

}  // namespace tanktread
