#pragma once
// Results of one deck on several levels of refinement, and the errors estimated from them.

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/estimate.hpp"
#include "accuracy/levels.hpp"
#include "accuracy/request.hpp"
#include "record/files/run_record.hpp"

namespace tanktread::accuracy {

/// A finished level.
struct Outcome {
  Level level;
  std::filesystem::path directory;
  output::RunRecord record;
  double seconds = 0;  ///< wall seconds that the level has taken
};

/// Returns whether two decks differ at most in `Time/final time` and the section `Output`, so that a run of one deck can be resumed with the other
/// deck.
bool resumes(const std::string& one, const std::string& other);

/// Returns the finished run in a directory. Returns nothing if the directory has no run, if its run has not reached its end, if its deck is not
/// `deck`, or if its record is damaged.
std::optional<Outcome> finished(const std::filesystem::path& directory, const Level& level, const std::string& deck);

/// Returns whether a run is a branch of steady shapes. Of such a run, only the folds and the last point can be compared with other levels.
bool is_branch(const output::RunRecord& record);

/// Returns a series as a function of time. For a branch of steady shapes, returns the values at its folds and its last point as a function of their
/// index, because all other points differ between levels. A record with one row gives one point.
Curve curve(const output::RunRecord& record, const std::string& series);

/// The estimate for one request.
struct RequestResult {
  Request request;
  Estimate estimate;
  double value = 0;      ///< value to which the error belongs: the largest magnitude over the run, the last value, or the average
  double allowed = 0;    ///< largest error that the request allows, in the unit of the series; for a relative request, at least the round-off error
  bool met = false;
  bool vanishes = false;  ///< true if a relative request cannot be met: the values of the series are not larger than its differences between levels
  /// statistical error of a time average over several particles, not included in `estimate`; NaN if unknown
  double statistical = std::numeric_limits<double>::quiet_NaN();
};

/// Returns the estimated error for a request, and whether it meets the request, from the levels finished so far, coarse to fine. `looser`: result of
/// level 2 with a looser time tolerance, if it was computed; it shows which share of the error is due to the time integration.
RequestResult answer(const Request& request, const std::vector<Outcome>& levels, const std::optional<Outcome>& looser = {});

/// Returns the part of the error of `level` that is due to one part of the discretisation (time integration or quadrature), for a request. `looser`:
/// a run in which only this part of the discretisation is one level looser. `ratio`: factor by which one level reduces this part of the error.
double part_error(const Request& request, const Outcome& level, const Outcome& looser, double ratio);

/// Returns the reason, as a clause, why no error of this scene can be estimated from levels; empty if errors can be estimated. Checks the finest
/// level:
/// - for forces of the contact limiter, because these forces depend on the time step;
/// - for warnings that the mesh does not represent wrinkles, or that the mesh has reached its largest size.
std::string obstacle(const std::vector<Outcome>& levels);

/// Estimated error of a series of the finest level: one value per row.
struct SeriesError {
  std::string name, unit, si;
  std::vector<double> values;  ///< estimated error at each row; NaN if it cannot be trusted
  std::string untrusted;       ///< reason why the estimate cannot be trusted; empty if it can
};

/// Returns the estimated errors of the finest level, one for each series with an error (`has_error`), in the order of the record. `looser`: result of
/// level 2 with a looser time tolerance, if it was computed. `answers`: estimates for the requests. If a request limits the largest error of a series
/// over the run, its estimate is used for this series. If there are several such requests, the last one whose estimate can be trusted is used.
std::vector<SeriesError> errors(const std::vector<Outcome>& levels, const std::optional<Outcome>& looser = {},
                                const std::vector<RequestResult>& answers = {});

}  // namespace tanktread::accuracy
