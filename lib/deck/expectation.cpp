#include "deck/expectation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.hpp"
#include "deck/words.hpp"

namespace tanktread::deck {

double period_of(const std::string& series) { return series.ends_with("inclination") ? 180 : 0; }

void Expectation::declare(Section& section) {
  if (name.front() != '<')  // `<name>` is no expectation but a placeholder in the manual
    for (const char* key : {"value", "tolerance"})
      if (!section.given(key)) throw UserError(section.path(key) + " is missing; an expectation needs `value` and `tolerance`.");
  section.key("series", series, Choice{},
              "name of the output series that is compared with the expected value; by default the name of the expectation");
  section.key("value", value, any(), "of the series", "expected value of the output series (required; the default is not used)");
  section.key("tolerance", tolerance, positive(), "of the series, or 1",
              "largest allowed difference between computed and expected value; `kind` tells whether it is absolute or relative (required; the "
              "default is not used)");
  section.key("kind", kind, Choice{"absolute", "relative"},
              "kind of the tolerance of the expected value. `absolute`: limit of the difference. `relative`: limit of the difference "
              "divided by the expected value");
  section.key("at", at, not_negative(), "time",
              "time at which the output series is compared with the expected value; the final time of the run if not given");
  section.key("source", source, Choice{}, "source of the expected value, for example a publication");
  section.key("not binding", not_binding, Choice{},
              "reason why a missed expected value does not fail the run. If the text is empty (the default), a missed value fails the "
              "run; otherwise it is only reported, with this text. The program sets the text itself if the deck "
              "does not, and --set or a further deck on the command line changes a key that results depend on without stating the expected "
              "value again");
  if (kind == "relative" && value == 0.0)
    throw UserError(section.path("kind") +
                    " `relative` and the value 0 contradict each other: an error cannot be divided by 0. Give `absolute`.");
}

void Expectations::declare(Section& section) {
  section.each("a value that the results must have. The run ends with exit code 1 if a value is missed",
               [this](const std::string& name, Section& inner) {
                 Expectation expectation;
                 expectation.name = expectation.series = name;
                 expectation.declare(inner);
                 all.push_back(expectation);
               });
}

namespace {

/// Returns the difference up to which two times count as equal in a run that ends at the time `end`.
double slack(double time, double end) { return 1e-9 * std::max(std::abs(time), std::abs(end)); }

/// Returns the values of an angle without its jumps by a period.
std::vector<double> unwrapped(std::vector<double> values, double period) {
  for (std::size_t k = 1; k < values.size(); ++k)
    if (!std::isnan(values[k - 1])) values[k] = values[k - 1] + std::remainder(values[k] - values[k - 1], period);
  return values;
}

Verdict verdict(const Expectation& e, const SeriesTable& series, const UndefinedSeries& undefined) {
  Verdict out{e.name,       std::numeric_limits<double>::quiet_NaN(), e.value, std::numeric_limits<double>::quiet_NaN(), false, {},
              e.not_binding};
  const auto values = series.find(e.series), times = series.find("time");
  const double period = period_of(e.series);
  if (values == series.end() || values->second.empty()) {
    out.reason = "the results hold no series " + e.series;
    return out;
  }
  if (e.at) {
    const bool usable = times != series.end() && times->second.size() == values->second.size();
    const double near = usable ? slack(*e.at, times->second.back()) : 0;
    if (!usable || *e.at < times->second.front() - near || *e.at > times->second.back() + near) {
      out.reason = "the results do not reach the time " + number_text(*e.at);
      return out;
    }
    out.value = interpolated(times->second, period > 0 ? unwrapped(values->second, period) : values->second,
                             std::clamp(*e.at, times->second.front(), times->second.back()));
  } else {
    out.value = values->second.back();
  }
  if (period > 0) out.value = std::remainder(out.value, period);
  const double apart = period > 0 ? std::remainder(out.value - e.value, period) : out.value - e.value;
  out.error = std::abs(apart) / (e.kind == "relative" ? std::abs(e.value) : 1.0);
  out.passed = out.error <= e.tolerance;  // false if the error is NaN
  if (const auto condition = undefined.find(e.series); std::isnan(out.value) && condition != undefined.end())
    out.reason = e.series + " is undefined " + (e.at ? "at the time " + number_text(*e.at) : "at the end") + ", because " + condition->second;
  else if (!out.passed)
    out.reason = e.series + " is " + number_text(out.value) + ", expected " + number_text(e.value) + " within " + number_text(e.tolerance) +
                 (e.kind == "relative" ? " (relative)" : "");
  return out;
}

}  // namespace

void check_series(const std::vector<Expectation>& expectations, const std::vector<std::string>& names) {
  for (const Expectation& e : expectations) {
    if (!e.not_binding.empty() || std::ranges::find(names, e.series) != names.end()) continue;
    const std::string meant = guess(e.series, names), where = "Expect/" + e.name + (e.series == e.name ? "" : "/series");
    throw UserError(where + ": the results of this scene hold no series " + e.series +
                    (meant.empty() ? ", but " + alternatives(names) + "." : "; was " + meant + " meant?"));
  }
}

std::vector<std::string> too_late(const std::vector<Expectation>& expectations, double end) {
  std::vector<std::string> sentences;
  for (const Expectation& e : expectations)
    if (e.not_binding.empty() && e.at && *e.at > end + slack(*e.at, end))
      sentences.push_back("Expect/" + e.name + " will be missed: it is for the time " + number_text(*e.at) + ", and the run ends at " +
                          number_text(end));
  return sentences;
}

double interpolated(const std::vector<double>& times, const std::vector<double>& values, double t) {
  const std::size_t rows = times.size();
  const auto above = static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), t) - times.begin());
  if (above < rows && times[above] == t) return values[above];
  std::size_t begin = above, end = above;  // rows next to the time t: up to four on each side, without NaN
  while (begin > 0 && above - begin < 4 && !std::isnan(values[begin - 1])) --begin;
  while (end < rows && end - above < 4 && !std::isnan(values[end])) ++end;
  if (begin == above || end == above) return std::numeric_limits<double>::quiet_NaN();
  const std::size_t points = std::min<std::size_t>(4, end - begin), first = std::clamp(above < 2 ? 0 : above - 2, begin, end - points);
  double sum = 0;
  for (std::size_t i = first; i < first + points; ++i) {
    double weight = 1;
    for (std::size_t j = first; j < first + points; ++j)
      if (j != i) weight *= (t - times[j]) / (times[i] - times[j]);
    sum += weight * values[i];
  }
  return sum;
}

std::vector<Verdict> verdicts(const std::vector<Expectation>& expectations, const SeriesTable& series, const UndefinedSeries& undefined) {
  std::vector<Verdict> out;
  for (const Expectation& expectation : expectations) out.push_back(verdict(expectation, series, undefined));
  return out;
}

std::string missed(const std::vector<Verdict>& verdicts, const std::function<void(const std::string&)>& warn) {
  std::string line;
  for (const Verdict& one : verdicts) {
    if (one.passed) continue;
    const std::string found = "Expect/" + one.name + ": " + one.reason;
    if (one.not_binding.empty())
      line += (line.empty() ? "missed " : "; ") + found;
    else
      warn(found + "; this does not fail the run: " + one.not_binding);
  }
  return line;
}

}  // namespace tanktread::deck
