#pragma once
// Saved steps. Each is one closed file, at once an exact checkpoint and a picture for ParaView.

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "base/types.hpp"
#include "output/lagrange.hpp"

namespace tanktread::output {

/// What a run needs to go on, to the last bit: control nets, the frozen operator's geometry, the memory of the step controller, the
/// effective deck. Names are free but hold no '/'. Doubles come back with the same bits.
struct Checkpoint {
  std::map<std::string, Eigen::MatrixXd> arrays;
  std::map<std::string, double> numbers;
  std::map<std::string, std::string> texts;
};

/// A named array on the nodes (n_nodes, k) or on the cells (n_cells, k) of a picture.
struct Field {
  std::string name;
  Eigen::MatrixXd values;
};

/// The surface as ParaView draws it at one moment.
struct Picture {
  const LagrangeMesh& mesh;
  Eigen::MatrixXd points;           ///< (n_nodes, 3)
  std::vector<Field> point_fields;  ///< `Normals` among them gives smooth shading
  std::vector<Field> cell_fields;
};

/// Points and `Normals` of `net`; further fields are the caller's to add. `nodes` must outlive the picture.
Picture picture(const Nodes& nodes, const Net& net);

/// `snapshot_000123.hdf` for step 123.
std::string snapshot_name(int step);

/// Writes `/checkpoint` and `/VTKHDF` (version 1.0, UnstructuredGrid) of one step to `path`, whole or not at all.
/// Throws RunFailure when the disk refuses.
void write_snapshot(const std::filesystem::path& path, const Checkpoint& checkpoint, const Picture& picture);

/// The checkpoint of a snapshot. Throws std::runtime_error when the file is missing or damaged.
Checkpoint read_checkpoint(const std::filesystem::path& path);

/// A snapshot file of a directory.
struct Snapshot {
  std::filesystem::path path;
  int step = 0;
};

/// All of them, by step; readable or not.
std::vector<Snapshot> snapshots(const std::filesystem::path& directory);

/// The number "picture time" of its checkpoint, or "time"; empty when the file cannot be read or holds none.
std::optional<double> snapshot_time(const std::filesystem::path& path);

struct Saved {
  Snapshot file;
  Checkpoint checkpoint;
};

/// The newest snapshot of a directory that can be read; damaged ones are passed over. None: empty.
std::optional<Saved> newest_checkpoint(const std::filesystem::path& directory);

}  // namespace tanktread::output
