#pragma once
// A saved step, one closed file, at once an exact checkpoint and a picture for ParaView; and the list of all that a run has saved.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "record/files/checkpoint.hpp"
#include "record/files/file.hpp"
#include "record/files/nodes.hpp"

namespace tanktread::output {

/// What is written of a field: a row a node.
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A named array at the nodes of a picture, shape (nodes, k).
struct Field {
  std::string name;
  Rows values;
};

/// Places and normals of `net`: `Points`, which every picture has, and `Normals`, which give smooth shading. Further fields are the caller's to add.
std::vector<Field> picture(const Nodes& nodes, const Net& net);

/// Writes the file in one step (write_whole): `/checkpoint` and `/VTKHDF` (version 1.0, UnstructuredGrid) with `fields` at all nodes. Throws
/// RunFailure when the disk refuses.
void write_snapshot(const std::filesystem::path& path, const Checkpoint& checkpoint, const LagrangeMesh& mesh,
                    std::span<const Field> fields, Durable durable = Durable::no);

/// `run.hdf.series`, with which ParaView opens all snapshots of a run behind one time slider:
/// {"file-series-version":"1.0","files":[{"name":"snapshot_000000.hdf","time":0.0}, ...]}.
class SnapshotSeries {
 public:
  explicit SnapshotSeries(std::filesystem::path directory);

  /// The list that a resumed run goes on with: snapshots up to `step` that can be read and are of `run` (Picture).
  static SnapshotSeries resumed(std::filesystem::path directory, int step, const std::string& run);

  void add(int step, double time);  ///< the snapshot of a step, which stands in the directory already
  void write() const;               ///< rewrites the file

 private:
  struct Entry {
    int step;
    double time;
  };
  std::filesystem::path directory_;
  std::vector<Entry> entries_;
};

}  // namespace tanktread::output
