#include "accuracy/publication.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <span>
#include <sstream>

#include "accuracy/position.hpp"
#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "base/text_file.hpp"
#include "deck/expectation.hpp"
#include "deck/words.hpp"
#include "record/files/file.hpp"
#include "record/files/summary.hpp"

namespace tanktread::accuracy {

namespace {

namespace fs = std::filesystem;
using deck::in_quotes;
using deck::real_text;

/// Makes the files of `from` available in `to` under the same names: by hard links if the file system supports them, otherwise by copies.
void link_files(const fs::path& from, const fs::path& to) {
  for (const auto& entry : fs::directory_iterator(from)) {
    if (!entry.is_regular_file()) continue;
    const fs::path place = to / entry.path().filename();
    std::error_code failed;
    fs::remove(place, failed);
    fs::create_hard_link(entry.path(), place, failed);
    if (failed) fs::copy_file(entry.path(), place, fs::copy_options::overwrite_existing, failed);
    if (failed) throw RunFailure("cannot write " + place.string() + ": " + failed.message());
  }
}

/// Returns the error of the row at `time`, or the larger error of the rows before and after it. `times`: ascending times of the rows.
double error_at(const std::vector<double>& times, const std::vector<double>& errors, double time) {
  const auto after = static_cast<std::size_t>(std::ranges::lower_bound(times, time) - times.begin());
  if (after == 0 || after == times.size()) return after == 0 ? errors.front() : errors.back();
  return times[after] == time ? errors[after] : std::fmax(errors[after - 1], errors[after]);
}

/// Returns, for each expectation, the estimated error of its series at the time of the expectation; NaN if none is estimated.
std::vector<double> estimates(const deck::Expectations& expect, const std::vector<SeriesError>& errors, const std::vector<double>& times) {
  std::vector<double> all;
  for (const deck::Expectation& one : expect.all) {
    const auto found = std::ranges::find(errors, one.series, &SeriesError::name);
    if (found == errors.end())
      all.push_back(NAN);
    else
      all.push_back(one.at ? error_at(times, found->values, *one.at) : found->values.back());
  }
  return all;
}

std::string word(Of of) { return of == Of::run ? "run" : of == Of::end ? "end" : "mean"; }

std::string accuracy_text(const LadderRequest& task, const std::vector<Outcome>& levels, const std::vector<RequestResult>& answers,
                          const std::string& why, double seconds) {
  std::string text = "accuracy:\n  met: " + std::string(std::ranges::all_of(answers, &RequestResult::met) ? "true" : "false") + "\n";
  if (!why.empty()) text += "  stopped: " + in_quotes(why) + "\n";
  text += "  seconds: " + real_text(seconds) + "\n  requests:\n";
  for (const RequestResult& one : answers) {
    text += "    - request: " + in_quotes(one.request.text()) + "\n      series: " + in_quotes(one.request.series) + "\n      of: " +
            word(one.request.of) + "\n      value: " + real_text(one.value) + "\n      allowed: " + real_text(one.allowed) +
            "\n      estimated error: " + real_text(one.estimate.trusted() ? one.estimate.error : NAN) +
            (std::isnan(one.statistical) ? "" : "\n      statistical error: " + real_text(one.statistical)) + "\n      ratio: " +
            real_text(one.estimate.ratio) + "\n      met: " + (one.met ? "true" : "false") + "\n";
    if (!one.estimate.trusted()) text += "      untrusted: " + in_quotes(one.estimate.untrusted) + "\n";
  }
  text += "  levels:\n";
  for (const Outcome& one : levels) {
    std::string keys;
    for (const std::string& setting : settings(task.values, one.level)) keys += (keys.empty() ? "" : ", ") + in_quotes(setting);
    text += "    - {level: " + std::to_string(one.level.mesh) + ", seconds: " + real_text(one.seconds) + ", settings: [" + keys + "]}\n";
  }
  return text;
}

void print_warning(const std::string& sentence) { std::fprintf(stderr, "tanktread: warning: %s\n", sentence.c_str()); }

}  // namespace

std::string sentence(const RequestResult& one) {
  const std::string name = one.request.text();
  if (!one.estimate.trusted()) return name + ": the error cannot be estimated, because " + one.estimate.untrusted;
  const std::string found = name + formatted(": estimated error %.2g, allowed %.2g", one.estimate.error, one.allowed);
  if (one.met || one.estimate.error > one.allowed) return found;
  return found + formatted(" (a request is met if it allows %g times the estimated error)", margin);
}

std::string publish(const LadderRequest& task, const std::vector<Outcome>& levels, const std::vector<RequestResult>& answers,
                    const std::vector<SeriesError>& errors, const LadderEnd& end, double seconds) {
  const Outcome& finest = levels.back();
  output::start_results(task.directory);
  link_files(finest.directory, task.directory);
  if (levels.size() > 2 && !is_branch(finest.record) && obstacle(levels).empty()) {
    const std::span<const Outcome> last = std::span(levels).last(3);
    std::vector<double> expected;
    for (const Outcome& one : last) expected.push_back(expected_error(one.level));
    write_position_errors({last[0].directory, last[1].directory, last[2].directory}, expected, task.directory);
  }
  output::RunRecord record = finest.record;
  deck::SeriesTable table;
  for (const output::Series& series : record.series()) table[series.name] = series.values;
  for (const SeriesError& one : errors)
    record.add_error({one.name, one.unit,
                      one.untrusted.empty() ? "estimated error of the series" : "no error: it cannot be estimated, because " + one.untrusted,
                      one.values, one.si});
  record.move(task.directory / output::record_file);
  record.write(output::Durable::yes);

  const std::vector<deck::Verdict> verdicts = deck::verdicts(task.expect.all, table, task.undefined);
  std::string text = text_of_file(finest.directory / output::summary_file, output::summary_file, 10'000'000);
  for (const std::string& one : output::listed(text, "warnings")) print_warning(one);
  if (!end.status.empty()) text = output::with_entry(text, "status", output::yaml_status(end.status));
  text = output::with_entry(text, "expect", output::yaml(verdicts, estimates(task.expect, errors, table.at("time"))));
  text = output::with_entry(text, "estimated errors", "");  // the sections `error` and `accuracy` replace it
  text += "error:\n";
  for (const SeriesError& one : errors)
    text += "  " + (deck::is_plain(one.name) ? one.name : in_quotes(one.name)) + ": " + real_text(one.values.back()) + "\n";
  text += accuracy_text(task, levels, answers, end.reason, seconds);
  output::write_whole(task.directory / output::summary_file, text, output::Durable::yes);
  return deck::missed(verdicts, print_warning);
}

}  // namespace tanktread::accuracy
