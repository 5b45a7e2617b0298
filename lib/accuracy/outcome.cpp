#include "accuracy/outcome.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "base/errors.hpp"
#include "base/text_file.hpp"
#include "deck/expectation.hpp"
#include "record/files/summary.hpp"

namespace tanktread::accuracy {

namespace {

/// Returns the text of the summary of a run; empty if there is none.
std::string summary_of(const std::filesystem::path& directory) {
  const std::filesystem::path path = directory / output::summary_file;
  if (std::error_code absent; !std::filesystem::exists(path, absent)) return {};
  return text_of_file(path, path.string(), 10'000'000);
}

bool holds(const output::RunRecord& record, const std::string& name) {
  return std::ranges::find(record.series(), name, &output::Series::name) != record.series().end();
}

/// Returns the values whose error a request limits, as a curve: the whole series, its last value, or its average.
Curve part(const Curve& whole, Of of) {
  if (of == Of::run || whole.at.empty()) return whole;
  return {{0}, {of == Of::end ? whole.values.back() : average(whole).value}};
}

/// Returns the largest magnitude of the values that are not NaN; 0 if there are none.
double magnitude(const Curve& whole) { return std::fmax(largest(whole.values), 0); }

/// Returns the changes of a series from each level to the next finer one, coarse to fine.
std::vector<Curve> changes(const std::string& series, Of of, const std::vector<Outcome>& levels) {
  std::vector<Curve> found;
  for (std::size_t k = 1; k < levels.size(); ++k)
    found.push_back(difference(part(curve(levels[k].record, series), of), part(curve(levels[k - 1].record, series), of), deck::period_of(series)));
  return found;
}

/// Returns the error of time integration at a level divided by the error of time integration at level 2.
double relative_time_error(const Level& level) { return std::pow(time_ratio, 2 - level.time); }

/// Returns the errors to expect at the levels, up to a common factor; estimated() uses them. By default these are expected_error() of each level. If
/// there are at least 4 levels and level 2 was also computed with a looser time tolerance (`looser`), the part of the error due to time integration
/// is measured. This part is assumed to decrease with the time tolerance, and the rest of the error like expected_error().
std::vector<double> expected_errors(const std::vector<Outcome>& levels, const Request& request, double scale,
                                    const std::optional<Outcome>& looser) {
  std::vector<double> sizes;
  for (const Outcome& one : levels) sizes.push_back(expected_error(one.level));
  if (!looser || levels.size() < 4) return sizes;
  const std::vector<double> first = norms(changes(request.series, request.of, {levels.begin(), levels.begin() + 3}));
  const double whole = estimated(first, scale, {sizes.begin(), sizes.begin() + 3}).error, size = sizes[2];
  const double share = part_error(request, levels[2], *looser, time_ratio) / whole;
  if (!(share > 0)) return sizes;
  const double of_time = std::min(share, 0.8);
  for (std::size_t k = 0; k < sizes.size(); ++k) sizes[k] = (1 - of_time) * sizes[k] / size + of_time * relative_time_error(levels[k].level);
  return sizes;
}

/// Returns the largest magnitude of all series with the unit of `series`. Differences that are tiny compared with it are round-off. The magnitude of
/// `series` itself is not suitable, because a component may vanish by symmetry. Other series that are undefined (NaN) at some times are left out,
/// because they may be arbitrarily large shortly before and after these times.
double scale_of(const output::RunRecord& record, const std::string& series) {
  const auto one = std::ranges::find(record.series(), series, &output::Series::name);
  double most = 0;
  for (const output::Series& other : record.series())
    if (one != record.series().end() && other.unit == one->unit && has_error(other.name) &&
        (other.name == series || std::ranges::none_of(other.values, [](double value) { return std::isnan(value); })))
      most = std::max(most, magnitude(curve(record, other.name)));
  return most;
}

/// Returns whether the magnitude of a series changes by more than a factor of 1.5 among the last three levels. An oscillation keeps its magnitude,
/// even if the oscillations on different levels are out of phase.
bool is_noise(const std::vector<Outcome>& levels, const std::string& series) {
  std::vector<double> sizes;
  for (std::size_t k = levels.size() - 3; k < levels.size(); ++k) sizes.push_back(magnitude(curve(levels[k].record, series)));
  return std::ranges::max(sizes) > 1.5 * std::ranges::min(sizes);
}

bool is_of_several(const output::RunRecord& record) {
  return std::ranges::any_of(record.series(), [](const output::Series& one) { return one.name.find('/') != std::string::npos; });
}

}  // namespace

bool is_branch(const output::RunRecord& record) { return holds(record, "fold"); }

bool resumes(const std::string& one, const std::string& other) {
  const auto kept = [](const std::string& deck) {
    std::istringstream lines(without_section(deck, "Output"));
    std::string text, line;
    while (std::getline(lines, line))
      if (!line.starts_with("    final time:")) text += line + "\n";
    return text;
  };
  return kept(one) == kept(other);
}

std::optional<Outcome> finished(const std::filesystem::path& directory, const Level& level, const std::string& deck) {
  if (!output::reached_end(output::status_of(summary_of(directory)))) return {};
  try {
    Outcome found{level, directory, output::RunRecord::load(directory / output::record_file), 0};
    if (found.record.deck() != deck) return {};
    if (holds(found.record, "wall_seconds")) found.seconds = found.record.values("wall_seconds").back();
    return found;
  } catch (const UserError&) {  // a damaged record: the level is run again
    return {};
  }
}

Curve curve(const output::RunRecord& record, const std::string& series) {
  if (!holds(record, series)) return {};
  const std::vector<double>& values = record.values(series);
  if (!is_branch(record)) return {record.values("time"), values};
  const std::vector<double>& fold = record.values("fold");
  Curve found;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (fold[k] != 0 || k + 1 == values.size()) found.at.push_back(static_cast<double>(found.at.size())), found.values.push_back(values[k]);
  return found;
}

double part_error(const Request& request, const Outcome& level, const Outcome& looser, double ratio) {
  const auto of = [&](const Outcome& one) { return part(curve(one.record, request.series), request.of); };
  return largest(difference(of(level), of(looser), deck::period_of(request.series)).values) / (ratio - 1);
}

std::string obstacle(const std::vector<Outcome>& levels) {
  const Outcome& finest = levels.back();
  for (const output::Series& series : finest.record.series())
    if (series.name == "contact_impulse" && series.values.back() > 0)
      return "Contact/limiter holds particles apart by forces that depend on the time step";
  const std::vector<std::string> all = output::listed(summary_of(finest.directory), "obstacles");
  return all.empty() ? "" : all.front();
}

namespace {

/// Returns the error of the finest level if the errors of the mesh and of the time integration cancel in the difference between the last two levels,
/// so that (9.1) is too small; otherwise returns 0. The two errors certainly cancel if the known change of the time error between these levels is
/// much larger than their difference `last`. The change of the mesh error is then the sum of `last` and the change of the time error.
double cancelled(const Request& request, const std::vector<Outcome>& levels, double last, const std::optional<Outcome>& looser) {
  constexpr double much = 2;
  if (!looser || levels.size() < 4) return 0;
  const Level &fine = levels.back().level, &coarse = levels[levels.size() - 2].level;
  const double of_level_2 = part_error(request, levels[2], *looser, time_ratio);
  const auto of_time = [&](const Level& level) { return of_level_2 * relative_time_error(level); };
  const double change = of_time(coarse) - of_time(fine);
  if (!(change > much * last)) return 0;
  return predicted_error(last + change, expected_error(coarse), expected_error(fine), expected_error(fine)) + of_time(fine);
}

/// Returns the estimated error of the series of a request. `from_level_to_level`: result of changes(). `tiny`: true if the last two of them are much
/// smaller than the request allows; the larger one is then an estimate even if they do not fall regularly.
Estimate estimate(const Request& request, const std::vector<Outcome>& levels, const std::optional<Outcome>& looser,
                  const std::vector<Curve>& from_level_to_level, bool tiny = false) {
  const double scale = scale_of(levels.back().record, request.series);
  const std::vector<double> differences = norms(from_level_to_level);
  Estimate found = estimated(from_level_to_level, scale, expected_errors(levels, request, scale, looser));
  if (tiny && !found.trusted()) {
    const double before = differences[differences.size() - 2];
    found = {std::max(differences.back(), found.ratio > most_ratio ? before / most_ratio : before), found.ratio, ""};
  }
  if (!differences.empty()) found.error = std::max(found.error, cancelled(request, levels, differences.back(), looser));
  return found;
}

}  // namespace

RequestResult answer(const Request& request, const std::vector<Outcome>& levels, const std::optional<Outcome>& looser) {
  RequestResult found;
  found.request = request;
  const Curve whole = curve(levels.back().record, request.series), of_part = part(whole, request.of);
  found.value = request.of == Of::run ? magnitude(whole) : of_part.values.back();
  const double scale = scale_of(levels.back().record, request.series);
  found.allowed = request.relative ? std::max(request.value * magnitude(whole), round_off * scale) : request.value;
  const std::vector<Curve> from_level_to_level = changes(request.series, request.of, levels);
  const std::vector<double> sizes = norms(from_level_to_level);
  const bool tiny = sizes.size() > 1 && sizes.back() <= found.allowed / 10 && sizes[sizes.size() - 2] <= found.allowed / 10;
  found.estimate = estimate(request, levels, looser, from_level_to_level, tiny);
  if (request.of == Of::mean) found.estimate.error += average(whole).error;
  if (request.of == Of::mean && is_of_several(levels.back().record)) found.statistical = statistical_error(whole);
  const std::vector<double> noise = norms(changes(request.series, Of::run, levels));
  found.vanishes = request.relative && !tiny && noise.size() > 1 && std::min(noise.back(), noise[noise.size() - 2]) > magnitude(whole) / 2 &&
                   is_noise(levels, request.series);
  if (found.vanishes) found.estimate.untrusted = "the series is not larger than its differences between levels: request an absolute accuracy";
  if (const std::string why = obstacle(levels); !why.empty()) found.estimate.untrusted = why;
  found.met = found.estimate.trusted() && margin * found.estimate.error <= found.allowed;
  return found;
}

std::vector<SeriesError> errors(const std::vector<Outcome>& levels, const std::optional<Outcome>& looser, const std::vector<RequestResult>& answers) {
  const std::string why = obstacle(levels);
  std::vector<SeriesError> all;
  const output::RunRecord& finest = levels.back().record;
  for (const output::Series& series : finest.series()) {
    if (!has_error(series.name)) continue;
    SeriesError one{series.name, series.unit, series.si, {}, {}};
    const std::vector<Curve> pairs = changes(series.name, Of::run, levels);
    const Curve whole = curve(finest, series.name);
    Estimate whole_run = estimate({series.name, Of::run, 0, false}, levels, looser, pairs);
    for (bool requested = false; const RequestResult& answer : answers) {
      if (answer.request.series != series.name || answer.request.of != Of::run || (requested && !answer.estimate.trusted())) continue;
      whole_run = answer.estimate, requested = true;
    }
    one.untrusted = why.empty() ? whole_run.untrusted : why;
    if (one.untrusted.empty()) {
      std::vector<double> at = is_branch(finest) ? std::vector<double>() : finest.values("time");
      // On a branch of steady shapes, errors are estimated only at folds and at the end of the branch. Each row takes the error of the next fold, or
      // the error at the end if no fold follows.
      if (const double folds = static_cast<double>(whole.at.size() - 1); at.empty())
        for (double k = 0; const double fold : finest.values("fold")) at.push_back(std::min(k, folds)), k += fold != 0;
      one.values = envelope(pairs.back(), at);
      const double factor = whole_run.error / std::max(largest(pairs.back().values), std::numeric_limits<double>::min());
      for (double& value : one.values) value *= factor;
    } else {
      one.values.assign(series.values.size(), std::numeric_limits<double>::quiet_NaN());
    }
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace tanktread::accuracy
