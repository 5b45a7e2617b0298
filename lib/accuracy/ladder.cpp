#include "accuracy/ladder.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>

#include "accuracy/outcome.hpp"
#include "accuracy/publication.hpp"
#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "base/stop.hpp"
#include "base/text_file.hpp"
#include "deck/words.hpp"
#include "record/files/checkpoint.hpp"
#include "record/files/file.hpp"
#include "system/parallel/agreement.hpp"
#include "system/parallel/ranks.hpp"

namespace tanktread::accuracy {

namespace {

namespace fs = std::filesystem;
using output::failure_file, output::ladder_file, output::summary_file;

/// Calls `choose` on the first rank only, and returns its result (a number, or true or false) on all ranks. Collective.
double decided(const auto& choose) { return coupling::decided([&] { return std::vector{static_cast<double>(choose())}; })[0]; }

/// Decision about a level: it is finished, it failed with the same deck and is not run again, it is resumed, or it is run anew.
enum class Start { finished, failed, resume, anew };

/// Text between deck and reason in `failure_file`, which is written for a level whose search for a steady or periodic shape failed, so that a resumed
/// ladder (runs on finer and finer levels) does not search again. Time-dependent runs that failed are continued from their checkpoint instead.
constexpr const char* before_reason = "\n--- failed: ";

class Ladder {
 public:
  Ladder(const LadderRequest& task, const Program& program) : task_(task), program_(program) {}

  int climb() {
    if (!task_.resume) check_start();
    serially([this] { prepare(); });
    for (int k = 0; k < task_.options.levels && k <= last_level; ++k) {
      if (const std::string why = is_over(k) ? "" : reason_to_stop(k); !why.empty()) return conclude(Exit::stopped, why);
      if (k >= balanced_from && count_ == k && !balanced_ && !within_reach(k) && balance() == Exit::stopped)
        return conclude(Exit::stopped, "a run that balances the parts was stopped");
      const int code = run(k);
      if (code == Exit::stopped) return conclude(Exit::stopped, formatted("level %d was stopped", k));
      if (count_ >= 3 && failure_of_last_.empty() && judge(k)) return conclude(Exit::done, "");
      if (hopeless()) return conclude(Exit::missed, "finer levels are not expected to reduce the error");
    }
    if (count_ == 0) throw RunFailure("no accuracy level was completed: " + failure_);
    if (!failure_of_last_.empty()) return conclude(Exit::missed, formatted("level %d failed: ", task_.options.levels - 1) + failure_);
    return conclude(Exit::missed, formatted("level %d is the finest one that Accuracy/levels allows", task_.options.levels - 1));
  }

 private:
  // First level whose time and quadrature tolerances are chosen by `balanced` from the measured shares of the time and quadrature errors in the total
  // error. The shares are measured at level 2, so levels 0 to 2 cannot use them.
  static constexpr int balanced_from = 3;

  fs::path directory(const std::string& name) const { return task_.directory / output::level_folder(name); }

  /// Runs `act` on the first rank. All ranks throw if it fails.
  void serially(const std::function<void()>& act) const { coupling::together(ranks_.rank() == 0, act); }

  /// Prints a line on the first rank.
  void say(const std::string& line) const {
    if (ranks_.rank() == 0 && !task_.quiet) std::printf("%s\n", line.c_str()), std::fflush(stdout);
  }

  /// Throws UserError if level 0 cannot start, before earlier results are deleted. Other failures are those of the level, see run_deck().
  void check_start() const try {
    program_.check_start(program_.deck(settings(task_.values, level_at(0))));
  } catch (const RunFailure&) {
  }

  void prepare() {
    if (task_.resume && !fs::exists(task_.directory / ladder_file))
      throw UserError("Accuracy cannot be added to a run that continues: run the deck again with another --output.");
    occupation_ = std::make_unique<output::Occupation>(task_.directory);
    if (!task_.resume) {
      if (!task_.overwrite) output::check_vacant(task_.directory);
      output::start_directory(task_.directory);
    }
    output::write_whole(task_.directory / ladder_file, task_.deck);
  }

  /// Returns whether the directory of level k in a resumed ladder holds results or a recorded failure. Such a level probably need not be run again.
  /// The deck of the earlier run is not compared, because it depends on shares of the error that are measured later.
  bool is_over(int k) const {
    return decided([&] {
      std::error_code absent;
      const fs::path place = directory(std::to_string(k));
      return task_.resume && (fs::exists(place / summary_file, absent) || fs::exists(place / failure_file, absent));
    }) != 0;
  }

  /// Returns the reason not to run level k if it is predicted to exceed the wall-clock limit of all levels together, otherwise an empty text.
  std::string reason_to_stop(int k) const {
    const auto limit = task_.options.wall_clock_limit;
    if (!limit) return {};
    const double so_far = ranks_.seconds_since(start_), next = decided([&] { return predicted_seconds(seconds()); });
    if (so_far + next <= *limit) return {};
    return formatted("level %d is predicted to take %.3g s, which exceeds Accuracy/wall-clock limit, %g s", k, next, *limit);
  }

  /// Returns the wall seconds of the finished levels.
  std::vector<double> seconds() const {
    std::vector<double> all;
    for (const Outcome& one : levels_) all.push_back(one.seconds);
    return all;
  }

  /// Runs level k, unless it is finished already. Returns Exit::stopped if the run was interrupted and can be resumed, or 0 if the run ended or
  /// failed.
  int run(int k) {
    std::optional<Outcome> outcome;
    const int code = run_level(level_at(k), std::to_string(k), outcome);
    if (code == Exit::stopped || !failure_of_last_.empty()) return code;
    if (ranks_.rank() == 0) levels_.push_back(std::move(*outcome));
    ++count_;
    return 0;
  }

  Level level_at(int k) const { return k < balanced_from ? same(k) : balanced(k, shares_[0], shares_[1]); }

  /// Returns whether level k is expected to meet all requests. If so, the additional runs of balance() would cost more than they save.
  bool within_reach(int k) const {
    return decided([&] {
      const double gain = levels_.empty() ? 1 : expected_error(level_at(k)) / expected_error(levels_.back().level);
      return std::ranges::all_of(answers_, [&](const RequestResult& one) { return margin * gain * one.estimate.error <= one.allowed; });
    }) != 0;
  }

  /// Measures which shares of the error are due to time integration and to quadrature, and stores them in shares_. For this, runs level 2 again with
  /// a looser time tolerance, and again with a looser quadrature tolerance. Each share is the largest among all series for which the user requests
  /// an accuracy that is not met yet, without series that are zero up to their error (RequestResult::vanishes). Returns Exit::stopped if a run was
  /// interrupted and can be resumed, otherwise 0.
  int balance() {
    balanced_ = true;
    std::optional<Outcome> quadrature;
    if (run_level(same_but_looser(2, &Level::time), "2_time", looser_) == Exit::stopped ||
        run_level(same_but_looser(2, &Level::quadrature), "2_quadrature", quadrature) == Exit::stopped)
      return Exit::stopped;
    const auto found = coupling::decided([&] {
      std::vector<double> most;
      for (const Request& request : task_.options.requests) {
        const RequestResult finest = answer(request, levels_);
        const double whole = finest.estimate.error;
        if (finest.met || finest.vanishes || !(whole > 0) || !looser_ || !quadrature) continue;
        const double of_time = part_error(request, levels_[2], *looser_, time_ratio) / whole;
        const double of_quadrature = part_error(request, levels_[2], *quadrature, quadrature_ratio) / whole;
        most = most.empty() ? std::vector{of_time, of_quadrature} : std::vector{std::max(most[0], of_time), std::max(most[1], of_quadrature)};
      }
      return most.empty() ? std::vector<double>{shares_} : most;
    });
    shares_ = {found[0], found[1]};
    return 0;
  }

  /// Runs one level in its directory, unless it is finished already. Sets `outcome` on the first rank. Returns Exit::stopped if the run was
  /// interrupted and can be resumed, or 0 if the run ended or failed. If the deck of a new level is invalid (UserError) and a coarser level is
  /// finished, the level counts as failed.
  int run_level(const Level& level, const std::string& name, std::optional<Outcome>& outcome) try {
    failure_of_last_.clear();
    resuming_ = false;
    const std::string deck = program_.deck(settings(task_.values, level));
    std::string failure;  // reason for which an earlier run of this deck failed; set on the first rank
    const auto start = static_cast<Start>(static_cast<int>(decided([&] { return start_of(directory(name), level, deck, failure); })));
    resuming_ = start == Start::resume;
    if (start == Start::failed) {
      fail(name, failure + " (recorded by an earlier run; to search again, delete " + failure_file + ")");
      return 0;
    }
    double seconds = 0;
    if (start != Start::finished) {
      const auto limit = task_.options.wall_clock_limit;
      const double before = ranks_.seconds_since(start_);
      const int code = run_deck(name, deck, start == Start::resume, limit ? std::optional(std::max(1e-3, *limit - before)) : std::nullopt);
      seconds = ranks_.seconds_since(start_) - before;
      if (code == Exit::stopped || !failure_of_last_.empty()) {
        seconds_ += seconds;
        return code;
      }
    }
    serially([&] {
      outcome = finished(directory(name), level, deck);
      if (!outcome)
        throw RunFailure("the results of " + directory(name).string() +
                         " have changed since they were written: start again with --overwrite");
      outcome->seconds = std::max(seconds, outcome->seconds);
      seconds_ += outcome->seconds;
    });
    return 0;
  } catch (const UserError& error) {
    if (count_ == 0 || resuming_) throw;
    fail(name, error.what());
    return 0;
  }

  /// Runs a deck in the directory of the level `name`. If a search for a steady or periodic shape fails, stores the reason in `failure_file`. Returns
  /// Exit::stopped if the run was interrupted and can be resumed, or 0 if it ended or failed.
  int run_deck(const std::string& name, const std::string& deck, bool resume, std::optional<double> limit) {
    try {
      if (program_.run(deck, directory(name), resume, limit) == Exit::stopped) return Exit::stopped;
      return 0;
    } catch (const Stopped&) {
      return Exit::stopped;
    } catch (const RunFailure& failure) {
      fail(name, failure.what());
    }
    if (!task_.runs_in_time)
      serially([&] {
        fs::create_directories(directory(name));
        output::write_whole(directory(name) / failure_file, deck + before_reason + failure_);
      });
    return 0;
  }

  void fail(const std::string& name, const std::string& why) {
    failure_ = failure_of_last_ = why;
    say("  level " + name + " failed: " + why);
  }

  /// Returns the recorded reason for the failure of a run of this deck in this directory. Empty if no failure of this deck is recorded there.
  static std::string kept_failure(const fs::path& place, const std::string& deck) {
    try {
      const std::string text = text_of_file(place / failure_file, (place / failure_file).string(), 10'000'000), start = deck + before_reason;
      return text.starts_with(start) ? text.substr(start.size()) : "";
    } catch (const UserError&) {  // there is no such file
      return {};
    }
  }

  /// Returns the state of a level in the directory `place`. If the result is Start::failed, sets `failure` to the reason.
  Start start_of(const fs::path& place, const Level& level, const std::string& deck, std::string& failure) const {
    if (!task_.resume) return Start::anew;
    if (finished(place, level, deck)) return Start::finished;
    if (failure = kept_failure(place, deck); !failure.empty()) return Start::failed;
    std::error_code absent;
    if (!task_.runs_in_time || !fs::is_directory(place, absent)) return Start::anew;
    try {
      if (!resumes(output::RunRecord::load(place / output::record_file).deck(), deck)) return Start::anew;
    } catch (const UserError&) {  // there is no record, or it is damaged
      return Start::anew;
    }
    return output::obstacle_to_resuming(place).empty() ? Start::resume : Start::anew;
  }

  /// Estimates the error for each request from the finished levels. Called only on the first rank.
  void answer_all() {
    answers_.clear();
    for (const Request& request : task_.options.requests) answers_.push_back(answer(request, levels_, looser_));
  }

  /// Estimates the errors of the finest level k for all requests and prints one line per request. Returns whether all requests are met.
  bool judge(int k) {
    const bool all_met = decided([&] {
      answer_all();
      return std::ranges::all_of(answers_, &RequestResult::met);
    }) != 0;
    say(formatted("  level %-5d %d elements per side, tolerance %.2g, %.3g s", k, elements_per_side(k),
                  tolerance(level_at(k).time), levels_.empty() ? 0 : levels_.back().seconds));
    for (const RequestResult& one : answers_) say("              " + sentence(one));
    return all_met;
  }

  /// Returns whether finer levels are not expected to help. This is so if `obstacle` reports, for each of the two finest levels, a reason why no
  /// error can be estimated, or if every request that is not met is for a series that vanishes (RequestResult::vanishes).
  bool hopeless() const {
    return decided([&] {
      if (levels_.size() < 4) return false;
      const std::vector<Outcome> before(levels_.begin(), levels_.end() - 1);
      return (!obstacle(levels_).empty() && !obstacle(before).empty()) ||
             std::ranges::all_of(answers_, [](const RequestResult& one) { return one.met || one.vanishes; });
    }) != 0;
  }

  /// Publishes the finest finished level as the results, and returns the exit code.
  int conclude(Exit::Code code, const std::string& why) {
    if (decided([&] { return levels_.size(); }) == 0) {
      if (code == Exit::stopped) {
        if (ranks_.rank() == 0) report(code, why, "");
        return Exit::stopped;
      }
      throw RunFailure("no accuracy level was completed" + (failure_.empty() ? "" : ": " + failure_));
    }
    const std::string status = code == Exit::stopped ? program_.reason_of_stop() : "";
    return static_cast<int>(decided([&] {
      answer_all();
      const std::string missed_expectations = publish(task_, levels_, answers_, errors(levels_, looser_, answers_), {status, why}, seconds_);
      report(code, why, missed_expectations);
      return code == Exit::done && !missed_expectations.empty() ? Exit::missed : code;
    }));
  }

  void report(Exit::Code code, const std::string& why, const std::string& missed_expectations) const {
    std::string line = code == Exit::done ? "" : "the requested accuracy is not reached: " + why;
    if (code == Exit::stopped) line += "; --resume " + task_.directory.string() + " continues the run";
    for (const RequestResult& one : answers_)
      if (code != Exit::done && !one.met) line += "; " + sentence(one);
    if (!missed_expectations.empty()) line += (line.empty() ? "" : "; ") + missed_expectations;
    if (!line.empty()) std::fprintf(stderr, "tanktread: %s\n", line.c_str());
    if (!task_.quiet) std::printf("  results     %s\n", task_.directory.c_str());
  }

  const LadderRequest& task_;
  const Program& program_;
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  coupling::Ranks ranks_;
  std::unique_ptr<output::Occupation> occupation_;  // lock of the results directory, on the first rank
  std::vector<Outcome> levels_;                     // finished levels, on the first rank
  std::optional<Outcome> looser_;                   // result of level 2 with a looser time tolerance, on the first rank
  std::vector<RequestResult> answers_;              // estimated errors for the requests, on the first rank
  int count_ = 0;                                   // number of finished levels
  // wall seconds of all runs, on the first rank. Finished runs include the time before they were resumed
  double seconds_ = 0;
  bool balanced_ = false;                           // true if balance() has been called, which measures `shares_`
  std::vector<double> shares_{0.25, 0.25};          // shares of time integration and quadrature in the error at level 2
  bool resuming_ = false;                           // true if the latest run resumes an earlier one
  // failure_: message of the latest failed run. failure_of_last_: message of the latest run if it failed, otherwise empty
  std::string failure_, failure_of_last_;
};

}  // namespace

double predicted_seconds(const std::vector<double>& seconds) {
  const std::size_t n = seconds.size();
  if (n == 0) return 0;
  const double growth = n > 1 && seconds[n - 2] > 0 ? std::clamp(seconds[n - 1] / seconds[n - 2], 1.5, 5.) : 2.5;
  return seconds[n - 1] * growth;
}

std::optional<std::string> ladder_deck(const fs::path& directory) {
  std::error_code absent;
  if (decided([&] { return fs::is_regular_file(directory / ladder_file, absent); }) == 0) return {};
  return text_of_file(directory / ladder_file, (directory / ladder_file).string(), 10'000'000);
}

int climb(const LadderRequest& task, const Program& program) { return Ladder(task, program).climb(); }

}  // namespace tanktread::accuracy
