#pragma once
// What a deck expects of its results: `Expect/<name>`.

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "deck/section.hpp"

namespace tanktread::deck {

/// One expected value of a series.
struct Expectation {
  std::string name;               ///< the user's, of the list
  std::string series;             ///< the name itself, unless the deck says otherwise
  double value = 0;               ///< required
  double tolerance = 0;           ///< required; absolute, or relative to `value`
  std::string kind = "absolute";  ///< absolute, relative
  std::optional<double> at;       ///< time; empty: the last one
  std::string source;             ///< where the value comes from
  std::string not_binding;        ///< why a miss is reported only; empty: it fails the run

  void declare(Section& section);
};

/// All of `Expect/*`.
struct Expectations {
  std::vector<Expectation> all;
  void declare(Section& section);
};

/// Throws UserError, with the name that was probably meant, where one that binds is of a series that is not among `names`.
void check_series(const std::vector<Expectation>& expectations, const std::vector<std::string>& names);

/// A sentence for each binding expectation at a time after `end`, which a run that ends there misses.
std::vector<std::string> too_late(const std::vector<Expectation>& expectations, double end);

/// What became of one expectation.
struct Verdict {
  std::string name;
  double value = 0;  ///< found; not a number when there was nothing to look at
  double expected = 0;
  double error = 0;  ///< |value - expected|, over |expected| when the kind is relative
  bool passed = false;
  std::string reason = {};  ///< why nothing could be looked at, or how far it is off; empty when passed
  std::string not_binding = {};  ///< the expectation's
};

/// Series by name, rows in order of time, with the series `time` among them.
using SeriesTable = std::map<std::string, std::vector<double>>;

/// For each series that may be NaN, the condition under which it is, as a clause. The names are those of a SeriesTable.
using UndefinedSeries = std::map<std::string, std::string>;

/// Returns one verdict per expectation. A missing series, a time that was not reached, and a time at which the series is undefined are failures.
/// Between rows the value is that of the cubic through the four rows around the time.
std::vector<Verdict> verdicts(const std::vector<Expectation>& expectations, const SeriesTable& series, const UndefinedSeries& undefined = {});

/// Returns the value at t of the polynomial of degree <= 3 through the (at most four) points nearest to t. `times` ascend and t is in their range.
/// Values that are NaN, and what lies beyond them, are not used. The result is NaN if a row next to t is.
double interpolated(const std::vector<double>& times, const std::vector<double>& values, double t);

}  // namespace tanktread::deck
