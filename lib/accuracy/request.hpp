#pragma once
// Requested accuracy of results: section `Accuracy` of the deck.

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "deck/forward.hpp"

namespace tanktread::accuracy {

/// Choice of the error of a series that a request limits: the largest error over the run, the error of the last value, or the error of the time
/// average.
enum class Of { run, end, mean };

/// A request: `[<particle>/]<series>=<value>[%]`; `\@end` or `\@mean` may follow the series.
struct Request {
  std::string series;     ///< name of the series in `run.h5`, for example `taylor_inertia` or `left/velocity_x1`
  Of of = Of::run;        ///< largest error over the run, error of the last value, or error of the time average
  double value = 0;       ///< largest allowed error: relative if `relative`, otherwise in the unit of the series
  bool relative = false;  ///< true if `value` is relative to the largest magnitude of the series over the run

  /// Returns the request as the text that a deck contains.
  std::string text() const;
};

/// Reads one request. Throws UserError if the text does not have the form described at Request or the value is not positive.
Request request_of(const std::string& text);

/// Options `Accuracy/*` of the deck.
struct Options {
  bool present = false;  ///< true if the deck has the section Accuracy, which then contains at least one request
  std::vector<Request> requests;
  std::optional<double> wall_clock_limit;  ///< seconds that all levels together may take; no limit if not set
  int levels = 7;                          ///< largest number of levels

  /// Declares the keys. Throws UserError if no request is given or a request is malformed.
  void declare(deck::Section& section);
};

/// Returns the setting `Accuracy/requests=...` that is equivalent to the requests `texts` of the command line. `texts` is not empty.
std::string setting_of(const std::vector<std::string>& texts);

/// Throws UserError if a requested series is not among `names` (the message suggests the closest name), or if no error is estimated for it (see
/// `has_error`).
void check_series(const std::vector<Request>& requests, const std::vector<std::string>& names);

/// Returns whether an error of the series is estimated. No error is estimated for the time, for indices, for series that are errors themselves, and
/// for series that describe the work of a run (for example `wall_seconds`).
bool has_error(const std::string& series);

/// Returns the names of series without an error, except vectors, which has_error() finds by the beginning of their names.
std::span<const std::string_view> series_without_error();

}  // namespace tanktread::accuracy
