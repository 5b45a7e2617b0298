#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>

#include "accuracy/estimate.hpp"
#include "accuracy/ladder.hpp"
#include "accuracy/outcome.hpp"
#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "motion/guarded.hpp"
#include "system/parallel/agreement.hpp"

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

/// Returns the lowest level from 2 to `levels` - 1 at which the predicted error times `margin` is at most answer.allowed, or `levels` if there is
/// none. `difference`: difference of the result between levels 0 and 1, from which the error is extrapolated.
int needed(const RequestResult& answer, double difference, int levels) {
  const double factor = difference / (expected_error({}) - expected_error({1, 1, 1}));
  int level = 2;
  while (level < levels && margin * factor * expected_error({level, level, level}) > answer.allowed) ++level;
  return level;
}

}  // namespace

std::vector<std::string> forecast(const LadderRequest& task, const Program& program) {
  const Temporary directory;
  std::vector<std::string> lines;
  std::vector<Outcome> outcomes;
  for (int k = 0; k < 2; ++k) {
    const Level level{k, k, k};
    const std::string text = program.deck(settings(task.values, level));
    const fs::path place = directory.path / ("level_" + std::to_string(k));
    if (program.run(text, place, false, task.options.wall_clock_limit) == stopped) throw motion::Stopped();
    coupling::decided([&] {
      std::optional<Outcome> outcome = finished(place, level, text);
      if (!outcome) throw RunFailure("the pilot run failed before its final time");
      outcomes.push_back(std::move(*outcome));
      return std::vector<double>{0};
    });
  }
  coupling::decided([&] {
    int most = 2;
    for (const Request& request : task.options.requests) {
      const RequestResult one = answer(request, outcomes);
      if (std::isnan(one.estimate.error)) {
        lines.push_back("  accuracy    " + request.text() + ": no level can be predicted, because " + one.estimate.untrusted);
        continue;
      }
      const int level = needed(one, one.estimate.error, task.options.levels);
      most = std::max(most, level);
      lines.push_back("  accuracy    " + request.text() +
                      (level < task.options.levels ? formatted(": level %d is predicted to meet it", level)
                                                   : formatted(": no level up to %d is predicted to meet it", level - 1)));
    }
    double seconds = std::max(outcomes[1].seconds, 1e-3), whole = outcomes[0].seconds + seconds;
    const double growth = std::clamp(seconds / std::max(outcomes[0].seconds, 1e-3), 2., 3.5);
    for (int k = 2; k <= std::min(most, task.options.levels - 1); ++k) seconds *= growth, whole += seconds;
    lines.push_back(formatted("              about %.2g s in all, from a pilot run of the levels 0 and 1", whole));
    return std::vector<double>{0};
  });
  return lines;
}

}  // namespace tanktread::accuracy
