#pragma once
// Saved steps: what a run goes on from.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace tanktread::output {

/// What a run needs to go on, to the last bit: control nets, the frozen operator's geometry, the memory of the step controller, the
/// effective deck. Names are free but hold no '/'. Doubles come back with the same bits.
struct Checkpoint {
  std::map<std::string, Eigen::MatrixXd> arrays;
  std::map<std::string, double> numbers;
  std::map<std::string, std::string> texts;
};

/// Sixteen digits, others for any checkpoint that differs by a bit, short of a freak of chance; an attribute of `/checkpoint`.
std::string checksum(const Checkpoint& checkpoint);

/// `snapshot_000123.hdf` for step 123.
std::string snapshot_name(int step);

/// The checkpoint of a snapshot. Throws RunFailure when the system does not open it, std::runtime_error when it is damaged, be it by one bit.
Checkpoint read_checkpoint(const std::filesystem::path& path);

/// A snapshot file of a directory.
struct Snapshot {
  std::filesystem::path path;
  int step = 0;
};

/// All of them, by step; readable or not.
std::vector<Snapshot> snapshots(const std::filesystem::path& directory);

/// What a list of pictures needs of a snapshot.
struct Picture {
  double time = 0;  ///< the number "picture time" of the checkpoint, or "time"
  std::string run;  ///< its text "run", the identifier of the run
};

/// Empty when the file cannot be read.
std::optional<Picture> pictured(const std::filesystem::path& path);

struct Damaged {
  std::filesystem::path path;
  std::string reason;
};

struct Saved {
  Snapshot file;
  Checkpoint checkpoint;
  std::vector<Damaged> damaged;  ///< newer ones, the newest first
};

/// The newest snapshot of a directory that is sound. None: empty. Throws RunFailure when the system does not read one that is newer (permission, a
/// failing disk), since it may be sound.
std::optional<Saved> newest_checkpoint(const std::filesystem::path& directory);

}  // namespace tanktread::output
