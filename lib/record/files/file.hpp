#pragma once
// Files that are complete at any time: each is written under another name and then renamed. Functions for the directory of a run.

#include <bit>
#include <cinttypes>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace tanktread::output {

/// File that a run writes into its directory under a fixed name. `before_rows`: true if the run may write it before its first row. Such a file does
/// not show that a run has recorded something.
struct RunFile {
  const char* name;
  bool before_rows;
};

/// All files that a run writes into its directory under a fixed name. A run also writes snapshots (snapshot_name()) and copies of files that the deck
/// names. The table determines which files are results (is_result()), are deleted before another run writes into the directory (start_directory()),
/// prevent another run (check_vacant()), and are flushed at the end of a run (sync_results()).
constexpr RunFile run_files[] = {{"run.h5", false}, {"run.hdf.series", false}, {"summary.yaml", false},
                                 {"duct.h5", true}, {"channel.h5", true},      {"surface.iga", false}};

/// Returns the name of a file in the table `run_files`. Does not compile if the table lacks the name.
consteval const char* run_file(std::string_view name) {
  for (const RunFile& one : run_files)
    if (one.name == name) return one.name;
  throw "the table run_files lacks this name";
}

constexpr const char *record_file = run_file("run.h5"), *snapshot_list_file = run_file("run.hdf.series"), *summary_file = run_file("summary.yaml");
constexpr const char *duct_file = run_file("duct.h5"), *channel_file = run_file("channel.h5"), *surface_file = run_file("surface.iga");
constexpr std::string_view snapshot_start = "snapshot_", snapshot_end = ".hdf";  ///< start and end of the name of a snapshot; the step is in between

/// Returns true if a file of this name in the directory of a run is one of its results. Copies of files that the deck names have other names.
bool is_result(const std::string& name);

/// Names in the directory of an accuracy ladder (lib/accuracy: runs of one deck on finer and finer levels).
constexpr const char* ladder_file = "ladder.yaml";      ///< deck with its requests; a directory with this file is that of a ladder
constexpr const char* level_start = "level_";           ///< start of the name of the folder of a level, see level_folder()
constexpr const char* failure_file = "failure.txt";     ///< in the folder of a level: the deck of a search that failed, and the reason

/// Returns the name of the folder of a level: `level_3` for the level `3`.
inline std::string level_folder(const std::string& level) { return level_start + level; }

/// Checksum that depends on every bit of the added data (a chain of invertible steps, with the constants of FNV-1a).
class Checksum {
 public:
  void add(std::uint64_t word) { sum_ = std::rotl((sum_ ^ word) * 0x00000100000001b3u, 29); }
  void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
  void add(const std::string& text) {
    add(static_cast<std::uint64_t>(text.size()));
    for (const char c : text) add(static_cast<std::uint64_t>(static_cast<unsigned char>(c)));
  }

  /// Returns the checksum as sixteen hexadecimal digits.
  std::string digits() const {
    char text[17];
    std::snprintf(text, sizeof text, "%016" PRIx64, sum_);
    return text;
  }

 private:
  std::uint64_t sum_ = 0xcbf29ce484222325u;
};

/// Durability of a write: `yes` flushes the bytes of the file to the disk before the write returns, so that they survive a power failure; `no` leaves
/// the flushing to the system.
enum class Durable { no, yes };

/// Writes `bytes` to `path` atomically: a reader finds either the old or the new file, even if the process is killed during the write. Throws
/// RunFailure (disk full, no permission).
void write_whole(const std::filesystem::path& path, std::string_view bytes, Durable durable = Durable::no);

/// Waits until a file, or the entries of a directory, are on the disk. Throws RunFailure.
void sync(const std::filesystem::path& path);

/// Waits until the results of a run in its directory, the files of the names `copies` in it, and its entries are on the disk. Ignores names that do
/// not exist or are not regular files. Throws RunFailure.
void sync_results(const std::filesystem::path& directory, const std::set<std::string>& copies);

/// check_opens() throws RunFailure with the system's reason if a file cannot be opened (absent, no permission, too many open files, a pipe).
/// check_readable() also throws RunFailure if the file cannot be read to its end. A file that passes both checks but cannot be interpreted is
/// damaged.
void check_opens(const std::filesystem::path& path);
void check_readable(const std::filesystem::path& path);

/// Renames a file to `<name>.damaged`, or `<name>.damaged.2` and so on. No run is resumed from such a file. Returns the new path. Throws RunFailure
/// if the file cannot be renamed.
std::filesystem::path set_aside(const std::filesystem::path& path);

/// Throws UserError if a directory holds results of a run.
void check_vacant(const std::filesystem::path& directory);

/// Prepares `directory` for a run: creates it, and removes the results of an earlier run, the results and failure files of an accuracy ladder
/// (lib/accuracy) in the folders of its levels, and unfinished files. Removes only files with names that a run or a ladder writes. Throws UserError
/// if that fails.
void start_directory(const std::filesystem::path& directory);

/// Creates `directory` if necessary and removes the results and unfinished files in it, but keeps the runs of an accuracy ladder (lib/accuracy: one
/// deck at increasing resolution). Throws UserError if that fails.
void start_results(const std::filesystem::path& directory);

/// Prepares `directory` for `--resume`: removes only unfinished files. Throws UserError if that fails.
void tidy_directory(const std::filesystem::path& directory);

/// Lock that reserves a directory for this process. Creates the directory if necessary. The lock ends with this object or with the process, however
/// it ends, and leaves no file behind. If the file system has no locks or the directory cannot be opened, nothing is locked.
class Occupation {
 public:
  /// Locks the directory. Throws UserError if another process has locked it.
  explicit Occupation(const std::filesystem::path& directory);
  ~Occupation();
  Occupation(const Occupation&) = delete;
  Occupation& operator=(const Occupation&) = delete;

 private:
  int descriptor_ = -1;
};

/// Named array of numbers. Values are row-major; an empty shape is a scalar.
struct Array {
  std::string name, unit, description;
  std::vector<double> values;
  std::vector<std::size_t> shape;
};

/// Writes each array to the dataset `/<name>` of an HDF5 file: doubles with the attributes `unit` and `description`. Writes the file atomically
/// (write_whole). Throws RunFailure.
void write_arrays(const std::filesystem::path& path, const std::vector<Array>& arrays);

}  // namespace tanktread::output
