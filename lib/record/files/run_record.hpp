#pragma once
// The record of a run, `run.h5`: one row a finished step, whole at every moment.

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "record/files/file.hpp"

namespace tanktread::output {

/// One quantity over the steps. The names are promises to scripts outside the project.
struct Series {
  std::string name, unit, description;
  std::vector<double> values;  ///< one a row; row 0 is the initial state
  std::string si;  ///< what its unit is in SI units, if the deck says
};

/// `/series/<name>`, of one of several particles `/series/<particle>/<name>`, 1-D doubles of equal length with attributes `unit`, `description` and,
/// where the deck says what its units are, `SI`, `1e-06 m/s`;
/// `/deck`, the effective deck as text;
/// `/provenance`, whose attributes say what made the file (version, git_commit, compiler, ranks) and which `run` it is of.
///
/// The rows live here, and `write` puts all of them on disk in one step (write_whole): HDF5 1.10 cannot append to a file so that a process killed
/// within leaves one that every reader opens (its single-writer mode leaves a mark that refuses them). Serial: on several ranks only the first has a
/// record.
class RunRecord {
 public:
  /// A record without rows.
  RunRecord(std::filesystem::path path, std::string deck, std::map<std::string, std::string> provenance);

  /// The record that stands at `path`. Throws UserError when it is missing or damaged.
  static RunRecord load(const std::filesystem::path& path);

  /// Declares a series; all of them before the first row, and again after `load`. One that exists already keeps its values; a new
  /// one has none (not a number) in the rows that exist.
  void declare(std::string name, std::string unit, std::string description, std::string si = {});

  /// One row, a value for every series in the order of declaration. Writes nothing.
  void append(std::span<const double> row);

  /// Keeps the first `rows` rows, as a run that goes on from an earlier checkpoint does. Writes nothing.
  void truncate(std::size_t rows);

  /// Replaces deck and provenance (the resumed run may have other ranks and another final time). Writes nothing.
  void describe(std::string deck, std::map<std::string, std::string> provenance);

  void write(Durable durable = Durable::no) const;

  /// Of the first `rows` rows of every series, in whatever order the series were declared (Checksum).
  std::string checksum(std::size_t rows) const;

  std::size_t rows() const { return series_.empty() ? 0 : series_.front().values.size(); }
  const std::vector<Series>& series() const { return series_; }
  const std::vector<double>& values(std::string_view name) const;  ///< throws std::out_of_range
  const std::string& deck() const { return deck_; }
  const std::map<std::string, std::string>& provenance() const { return provenance_; }

 private:
  std::filesystem::path path_;
  std::string deck_;
  std::map<std::string, std::string> provenance_;
  std::vector<Series> series_;
};

}  // namespace tanktread::output
