// Prediction of the levels and seconds that a requested accuracy takes, from pilot runs of coarse levels.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <random>

#include "accuracy/estimate.hpp"
#include "accuracy/ladder.hpp"
#include "accuracy/outcome.hpp"
#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "base/stop.hpp"
#include "record/files/file.hpp"
#include "system/parallel/agreement.hpp"
#include "system/parallel/ranks.hpp"

namespace tanktread::accuracy {

namespace {

namespace fs = std::filesystem;

/// Temporary directory, one for all ranks, that is deleted with this object.
class Temporary {
 public:
  Temporary() {
    const auto number = coupling::decided([] { return std::vector<double>{static_cast<double>(std::random_device()())}; });
    path = fs::temp_directory_path() / formatted("tanktread-%.0f", number[0]);
  }
  ~Temporary() {
    std::error_code unused;
    fs::remove_all(path, unused);
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  fs::path path;
};

/// Returns the lowest level after the levels `pilots` and below `levels` at which the predicted error times `margin` is at most answer.allowed, or
/// `levels` if there is none. The error is extrapolated from the difference between the two pilots, answer.estimate.error.
int needed(const RequestResult& answer, const std::vector<Outcome>& pilots, int levels) {
  const auto error = [&](const Level& at) {
    return predicted_error(answer.estimate.error, expected_error(pilots[0].level), expected_error(pilots[1].level), expected_error(at));
  };
  int level = std::min(pilots[1].level.mesh + 1, levels);
  while (level < levels && margin * error(same(level)) > answer.allowed) ++level;
  return level;
}

/// Prints on the first rank that the pilot run of a level begins. `before`: outcomes of the pilot runs before it.
void announce(int level, const std::vector<Outcome>& before) {
  if (coupling::Ranks().rank() != 0) return;
  const std::string about = before.empty() ? "" : formatted(", about %.2g s", predicted_seconds({before[0].seconds}));
  std::printf("  accuracy    pilot run of level %d, with %d elements per side%s\n", level, elements_per_side(level), about.c_str());
  std::fflush(stdout);
}

}  // namespace

std::vector<std::string> forecast(const LadderRequest& task, const Program& program) {
  constexpr std::size_t enough = 2;
  constexpr int last_pilot = 3;
  const Temporary directory;
  std::vector<std::string> lines;
  std::vector<Outcome> outcomes;  // on the first rank
  std::string failure;
  std::size_t n = 0;
  for (int k = 0; k <= last_pilot && n < enough; ++k) {
    const Level level = same(k);
    const fs::path place = directory.path / output::level_folder(std::to_string(k));
    std::string text;
    const auto fail = [&](const std::string& why) { failure = formatted("level %d failed: ", k) + why; };
    if (!task.quiet) announce(k, outcomes);
    try {  // climb() continues after the same failures
      text = program.deck(settings(task.values, level));
      if (program.run(text, place, false, task.options.wall_clock_limit) == Exit::stopped) throw Stopped();
    } catch (const RunFailure& error) {
      const std::string what = error.what();
      fail(what.substr(0, what.find("; the checkpoint")));  // the checkpoint is deleted with the directory
      continue;
    } catch (const UserError& error) {
      if (n == 0) throw;
      fail(error.what());
      continue;
    }
    coupling::decided([&] {
      std::optional<Outcome> outcome = finished(place, level, text);
      if (!outcome) throw RunFailure("the pilot run failed before its final time");
      outcomes.push_back(std::move(*outcome));
      return std::vector<double>{0};
    });
    ++n;
  }
  if (n < enough) return {"  accuracy    no level can be predicted, because " + failure};
  coupling::decided([&] {
    const std::string why = obstacle(outcomes);
    int most = outcomes[1].level.mesh;
    for (const Request& request : task.options.requests) {
      const RequestResult one = answer(request, outcomes);
      if (!why.empty() || std::isnan(one.estimate.error)) {
        lines.push_back("  accuracy    " + request.text() + ": no level can be predicted, because " + one.estimate.untrusted);
        continue;
      }
      const int level = needed(one, outcomes, task.options.levels);
      most = std::max(most, level);
      lines.push_back("  accuracy    " + request.text() +
                      (level < task.options.levels ? formatted(": level %d is predicted to meet it", level)
                                                   : formatted(": no level up to %d is predicted to meet it", level - 1)));
    }
    double seconds = std::max(outcomes[1].seconds, 1e-3), whole = outcomes[0].seconds + seconds;
    const double growth = std::clamp(seconds / std::max(outcomes[0].seconds, 1e-3), 2., 3.5);
    for (int k = outcomes[1].level.mesh + 1; k <= std::min(most, task.options.levels - 1); ++k) seconds *= growth, whole += seconds;
    const bool over = task.options.wall_clock_limit && whole > *task.options.wall_clock_limit;
    lines.push_back(formatted("              about %.2g s in all, from a pilot run of the levels %d and %d%s", whole, outcomes[0].level.mesh,
                              outcomes[1].level.mesh, over ? "; more than Accuracy/wall-clock limit allows" : ""));
    return std::vector<double>{0};
  });
  return lines;
}

}  // namespace tanktread::accuracy
