#pragma once
// Runs of one deck on finer and finer levels until the requested accuracy is met.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/levels.hpp"
#include "accuracy/request.hpp"
#include "deck/expectation.hpp"
#include "record/files/exit_code.hpp"

namespace tanktread::accuracy {

/// Functions of the program with which one deck is run on finer and finer levels. All are collective.
struct Program {
  /// Returns the effective deck with the keys in `settings` (`Section/key=value`) changed, and without the sections Accuracy and Expect.
  std::function<std::string(const std::vector<std::string>& settings)> deck;

  /// Sets up the run of this deck, without writing anything. Throws UserError if the scene cannot start, for example because particles overlap.
  std::function<void(const std::string& deck)> check_start;

  /// Runs this deck with results in `directory`, or resumes the run there if `resume`. The run stops after `limit` seconds if given. Returns
  /// Exit::done, or Exit::stopped if the run can be resumed. Throws RunFailure if the run fails, and motion::Stopped if it is stopped before it can
  /// be resumed.
  std::function<int(const std::string& deck, const std::filesystem::path& directory, bool resume, std::optional<double> limit)> run;

  /// Returns the status of results that are stopped now: run_status::by_signal or run_status::by_clock (record/files/summary.hpp).
  std::function<std::string()> reason_of_stop;
};

/// A deck with requests.
struct LadderRequest {
  Options options;
  deck::Expectations expect;
  deck::UndefinedSeries undefined;  ///< conditions under which series are NaN
  Values values;        ///< values of all keys of the deck
  std::string deck;     ///< effective deck, with its requests
  std::filesystem::path directory;
  bool resume = false, overwrite = false, quiet = false;
  bool runs_in_time = true;  ///< false for searches for steady or periodic shapes, which cannot be resumed
};

/// Returns the deck of the ladder (runs on finer and finer levels) in a directory; nothing if the directory holds no ladder. Collective.
std::optional<std::string> ladder_deck(const std::filesystem::path& directory);

/// Runs a deck on finer and finer levels until all requests are met (lib/README.md, Accuracy on request). Level k runs in the folder `level_<k>` of
/// the directory. The results of the finest finished level become the results in the directory itself, with `/error/<series>` in `run.h5` and a
/// section `accuracy` in `summary.yaml`. If the task resumes, finished levels are kept and an unfinished level is resumed. Returns the exit code
/// (Exit): done if all requests are met; missed if a request is not met and no finer level is allowed or would help, or if an expectation is missed;
/// stopped if the runs were stopped by a signal or by the wall-clock limit, and can be resumed. Throws UserError if the directory already contains
/// results and the task neither resumes nor overwrites them, and if level 0 cannot start (then before any results are deleted). Throws RunFailure if
/// no level is completed. Collective.
int climb(const LadderRequest& task, const Program& program);

/// Runs the two coarsest levels that do not fail, of the levels 0 to 3, in a temporary directory. Returns lines of text on the first rank: for each
/// request, the lowest level that is predicted to meet it, and in the last line the predicted seconds of all levels. If fewer than two levels can be
/// run, returns one line with the reason on all ranks; otherwise other ranks return no lines. Like climb(), throws UserError if the deck of a level
/// is invalid and no coarser level is finished, and otherwise counts such a level as failed. Collective.
std::vector<std::string> forecast(const LadderRequest& task, const Program& program);

/// Returns the predicted wall seconds of the next level. `seconds`: wall seconds of all previous levels, coarse to fine. The last value is multiplied
/// by a growth factor: the ratio of the last two values, limited to 1.5 ... 5, or 2.5 if there is only one value.
double predicted_seconds(const std::vector<double>& seconds);

}  // namespace tanktread::accuracy
