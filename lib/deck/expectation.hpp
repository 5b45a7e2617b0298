#pragma once
// Expected values of results that a deck states in `Expect/<name>`, and their comparison with the results.

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "deck/section.hpp"

namespace tanktread::deck {

/// Returns the period of the values of a series: 180 degrees for the inclination of an axis; 0 for series that are not periodic.
double period_of(const std::string& series);

/// An expected value of a series.
struct Expectation {
  std::string name;               ///< name of the section, chosen by the user
  std::string series;             ///< name of the series; by default `name`
  double value = 0;               ///< expected value (required)
  double tolerance = 0;           ///< largest error of a value that meets the expectation (required): absolute, or relative to `value`
  std::string kind = "absolute";  ///< kind of the tolerance: absolute or relative
  std::optional<double> at;       ///< time of the expected value; if not set, the last time
  std::string source;             ///< source of the expected value, for example a publication
  std::string not_binding;        ///< if empty, the expectation is binding: the run fails if it is missed. Otherwise the reason why a missed
                                  ///< expectation is only reported

  void declare(Section& section);
};

/// All expectations of a deck (`Expect/*`).
struct Expectations {
  std::vector<Expectation> all;
  void declare(Section& section);
};

/// Throws UserError if the series of a binding expectation (`not_binding` is empty) is not among `names`. The message suggests the closest name.
void check_series(const std::vector<Expectation>& expectations, const std::vector<std::string>& names);

/// Returns one sentence per binding expectation (`not_binding` is empty) whose time is after `end`, because a run that ends at `end` cannot meet it.
std::vector<std::string> too_late(const std::vector<Expectation>& expectations, double end);

/// Result of the comparison of one expectation with the results.
struct Verdict {
  std::string name;
  double value = 0;  ///< value of the series in the results; NaN if there is none
  double expected = 0;
  double error = 0;  ///< |value - expected|, divided by |expected| if the kind is relative
  bool passed = false;
  std::string reason = {};       ///< message about the failure, with the value and the expected value; empty if passed
  std::string not_binding = {};  ///< Expectation::not_binding: reason why a failure is only reported; empty if it makes the run fail
};

/// Series of the results by name, including the series `time`. Rows are in the order of time.
using SeriesTable = std::map<std::string, std::vector<double>>;

/// Maps the name of each series that may be NaN to the condition under which it is NaN. The condition follows the word "because" in messages.
using UndefinedSeries = std::map<std::string, std::string>;

/// Returns one verdict per expectation. A missing series, a time that was not reached, and a time at which the series is undefined are failures.
/// Between rows the value is interpolated by the cubic through the four nearest rows (see `interpolated`).
std::vector<Verdict> verdicts(const std::vector<Expectation>& expectations, const SeriesTable& series, const UndefinedSeries& undefined = {});

/// Returns one line that lists the missed binding expectations; empty if there are none. Calls `warn` with a sentence for each missed expectation
/// that is not binding.
std::string missed(const std::vector<Verdict>& verdicts, const std::function<void(const std::string&)>& warn);

/// Returns the value at the time t of the polynomial of degree <= 3 through the points nearest to t, at most four. `times` ascend and t is in their
/// range. Points beyond a NaN value, seen from t, are not used. The result is NaN if a value next to t is NaN.
double interpolated(const std::vector<double>& times, const std::vector<double>& values, double t);

}  // namespace tanktread::deck
