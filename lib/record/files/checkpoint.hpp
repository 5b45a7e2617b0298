#pragma once
// Checkpoints, from which a run is resumed.
//
// Checkpoints of other versions of the program: a version may resume only if it reads every entry that it needs. Entries are read by `.at(name)`; if
// one is missing, Results::resumed() throws UserError. An entry may be missing only if its absence has one meaning: the run had no such data, for
// example no contacts, or all versions without the entry used one value of it. An entry that has changed its meaning gets another name.

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "motion/integrator.hpp"

namespace tanktread::output {

/// Data from which a run is resumed with bitwise the same results: control nets, the shape on which the frozen operator of implicit steps was
/// assembled, the memory of the step controller, the effective deck. Names must not contain '/'. Doubles are stored exactly.
struct Checkpoint {
  std::map<std::string, Eigen::MatrixXd> arrays;
  std::map<std::string, double> numbers;
  std::map<std::string, std::string> texts;
};

/// Returns a checksum of sixteen hexadecimal digits. Checkpoints that differ by a bit have different checksums, except by an improbable collision.
/// The checksum is stored as an attribute of `/checkpoint`.
std::string checksum(const Checkpoint& checkpoint);

/// Returns the file name of a snapshot: `snapshot_000123.hdf` for step 123.
std::string snapshot_name(int step);

/// Reads the checkpoint of a snapshot. Throws RunFailure if the system cannot open the file, std::runtime_error if the file is damaged, even by one
/// bit.
Checkpoint read_checkpoint(const std::filesystem::path& path);

/// Snapshot file in a directory.
struct Snapshot {
  std::filesystem::path path;
  int step = 0;
};

/// Returns all snapshot files of a directory, sorted by step. Unreadable files are included.
std::vector<Snapshot> snapshots(const std::filesystem::path& directory);

/// Data of a snapshot that are needed for the list of all snapshots.
struct SnapshotLabel {
  double time = 0;  ///< time of the snapshot: the number "picture time" of the checkpoint, or "time" if there is none
  std::string run;  ///< text "run" of the checkpoint, the identifier of the run
};

/// Returns the time and the run identifier of a snapshot file; nothing if the file cannot be read.
std::optional<SnapshotLabel> snapshot_label(const std::filesystem::path& path);

struct Damaged {
  std::filesystem::path path;
  std::string reason;
};

struct Saved {
  Snapshot file;
  Checkpoint checkpoint;
  std::vector<Damaged> damaged;  ///< damaged snapshot files that are newer than `file`, the newest first
};

/// Returns the checkpoint in the newest undamaged snapshot file of a directory; nothing if there is none. Throws RunFailure if the system cannot read
/// a newer snapshot file (permission, a failing disk), because the newer file may be undamaged.
std::optional<Saved> newest_checkpoint(const std::filesystem::path& directory);

/// Returns the newest undamaged snapshot file of the directory `path`. Returns `path` if it is no directory or if this file cannot be found.
std::filesystem::path newest_file(const std::filesystem::path& path);

/// Throws UserError, which says that another version of the program wrote the checkpoint, if `fits` is false.
void require_fit(bool fits);

/// Adds the complete state of a time integration to the checkpoint.
void store(motion::TimeState state, Checkpoint& checkpoint);

/// Returns the state that store() added to the checkpoint, bitwise the same, but without its vectors, which read_vectors() reads. Throws
/// std::out_of_range if a part is missing.
motion::TimeState stored_state(const Checkpoint& checkpoint);

/// Reads the vectors of a state that stored_state() has returned. Throws UserError if a block is missing or has another size.
void read_vectors(const Checkpoint& checkpoint, const std::shared_ptr<const coupling::Layout>& layout, motion::TimeState& state);

/// Returns the stacked control nets of all particles, also from checkpoints of earlier versions; no rows if the checkpoint has none.
Net stored_shapes(const Checkpoint& checkpoint);

/// Returns true if all ranks hold bitwise the same state. Collective.
bool equal_on_all_ranks(const motion::TimeState& state);

}  // namespace tanktread::output
