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

/// Returns the finished run in a directory; nothing if the directory has no run, its run has not reached its end, or its deck is not `deck`.
std::optional<Outcome> finished(const std::filesystem::path& directory, const Level& level, const std::string& deck);

/// Returns whether a run is a branch of steady shapes. Only its folds and its last point correspond to points of other levels.
bool is_branch(const output::RunRecord& record);

/// Returns a series as a function of time. For a branch of steady shapes, returns the values at its folds and its last point as a function of their
/// index, because all other points differ between levels. A run of one row gives one point.
Curve curve(const output::RunRecord& record, const std::string& series);

/// The estimate for one request.
struct Answer {
  Request request;
  Estimate estimate;
  double value = 0;      ///< value to which the error belongs: the largest magnitude over the run, the last value, or the average
  double allowed = 0;    ///< largest error that the request allows, in the unit of the series; for a relative request, at least the round-off error
  bool met = false;
  bool vanishes = false;  ///< true if a relative request cannot be met, because the series is not larger than its differences between levels
  double statistical = std::numeric_limits<double>::quiet_NaN();  ///< statistical error of a time average over several particles, not included in
                                                                  ///< `estimate`; NaN if unknown
};

/// Returns the answer to a request from the levels finished so far, coarse to fine. `looser`: result of level 2 with a looser time tolerance, if it
/// was computed; it shows which share of the errors is due to the time integration.
Answer answer(const Request& request, const std::vector<Outcome>& levels, const std::optional<Outcome>& looser = {});

/// Returns the error of `level` for a request that is due to one part of the discretisation (time integration or quadrature). `looser`: a run in
/// which only this part is one level looser. `ratio`: factor by which one level reduces the error of this part.
double part_error(const Request& request, const Outcome& level, const Outcome& looser, double ratio);

/// Returns why no error of this scene can be estimated from levels, as a clause; empty if it can. The finest level is checked for
/// - forces of the contact limiter, because they depend on the time step;
/// - a warning of wrinkles that its mesh does not represent, or of a mesh that has reached its largest size.
std::string obstacle(const std::vector<Outcome>& levels);

/// Estimated error of a series of the finest level: one value per row.
struct SeriesError {
  std::string name, unit, si;
  std::vector<double> values;  ///< estimated error at each row; NaN if it cannot be trusted
  std::string untrusted;       ///< reason why the estimate cannot be trusted; empty if it can
};

/// Returns the estimated errors of the finest level, one for each series with an error (`has_error`), in the order of the record. `looser`: see
/// `answer`.
std::vector<SeriesError> errors(const std::vector<Outcome>& levels, const std::optional<Outcome>& looser = {});

}  // namespace tanktread::accuracy
