#pragma once
// Record of a run, `run.h5`: one row per finished step. The file is complete at any time.

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "record/files/file.hpp"

namespace tanktread::output {

struct Saved;

/// One quantity as a function of the step. Scripts outside the project rely on the names of series.
struct Series {
  std::string name, unit, description;
  std::vector<double> values;  ///< one value per row; row 0 is the initial state
  std::string si;  ///< unit of the series in SI units, for example `1e-06 m/s`; empty if the deck does not set its units
};

/// Content of `run.h5`: `/series/<name>`, or `/series/<particle>/<name>` for one of several particles, 1-D doubles of equal length with attributes
/// `unit`, `description` and, if the deck sets its units, `SI`, for example `1e-06 m/s`;
/// `/error/<name>`, the estimated error of `/series/<name>` if the run is the finest of an accuracy ladder (lib/accuracy): same shape and attributes;
/// `/deck`, the effective deck as text;
/// `/provenance`, whose attributes state what made the file (version, git_commit, compiler, ranks) and to which `run` it belongs.
///
/// The rows are kept in memory, and `write` writes all of them atomically (write_whole). The reason: if a process is killed while it appends to a
/// file by HDF5 1.10, not every reader can open the file afterwards. The single-writer mode of HDF5 leaves a mark that readers refuse. Serial: with
/// several ranks only the first one has a record.
class RunRecord {
 public:
  /// Creates a record without rows.
  RunRecord(std::filesystem::path path, std::string deck, std::map<std::string, std::string> provenance);

  /// Reads the record at `path`. Throws UserError if it is missing or damaged.
  static RunRecord load(const std::filesystem::path& path);

  /// Reads the record of the run with this checkpoint, without the rows after it. Throws UserError if the record is missing, is damaged, or differs
  /// from the record that the run had when the checkpoint was saved.
  static RunRecord up_to(const Saved& saved);

  /// Declares a series. All series must be declared before the first row, and again after `load`. A series that exists already keeps its values. A
  /// new series is NaN in the rows that exist already.
  void declare(std::string name, std::string unit, std::string description, std::string si = {});

  /// Appends one row: a value for every series in the order of declaration. Writes nothing to the disk.
  void append(std::span<const double> row);

  /// Keeps only the first `rows` rows, for a run that is resumed from an earlier checkpoint. Writes nothing to the disk.
  void truncate(std::size_t rows);

  /// Replaces deck and provenance (a resumed run may have another number of ranks and another final time). Writes nothing to the disk.
  void describe(std::string deck, std::map<std::string, std::string> provenance);

  /// Adds the estimated error of a series, one value per row.
  void add_error(Series error) { errors_.push_back(std::move(error)); }

  /// Changes the path to which `write` writes the file.
  void move(std::filesystem::path path) { path_ = std::move(path); }

  void write(Durable durable = Durable::no) const;

  /// Returns the checksum of the first `rows` rows of every series, independent of the order of declaration (Checksum). A series whose values in
  /// these rows are all NaN does not contribute. Thus a series that a resumed run adds does not change the checksum of earlier rows.
  /// `with_undefined`: true to include such series, as checkpoints of earlier versions do.
  std::string checksum(std::size_t rows, bool with_undefined = false) const;

  std::size_t rows() const { return series_.empty() ? 0 : series_.front().values.size(); }
  const std::vector<Series>& series() const { return series_; }
  const std::vector<double>& values(std::string_view name) const;  ///< returns the values of a series; throws std::out_of_range if there is no series
                                                                   ///< of this name
  const std::string& deck() const { return deck_; }
  const std::map<std::string, std::string>& provenance() const { return provenance_; }

 private:
  std::filesystem::path path_;
  std::string deck_;
  std::map<std::string, std::string> provenance_;
  std::vector<Series> series_, errors_;
};

/// Entry of a checkpoint's texts that says why --resume cannot continue the run, as a clause. It is missing if the run makes time steps.
constexpr const char* not_resumed = "not resumed, because";

/// Reason why --resume refuses a checkpoint that lacks an entry.
constexpr const char* another_version =
    "its newest checkpoint was written by another version of tanktread and lacks data that this version needs to continue";

/// Returns the reason why --resume cannot continue the run in this directory, as a clause; empty if it can. Throws RunFailure if the system cannot
/// read a file.
std::string obstacle_to_resuming(const std::filesystem::path& directory);

}  // namespace tanktread::output
