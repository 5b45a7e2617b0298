#pragma once
// Snapshot: one file per saved step that is both an exact checkpoint and a mesh with fields for ParaView. List of all snapshots of a run.

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "record/files/checkpoint.hpp"
#include "record/files/file.hpp"
#include "record/files/nodes.hpp"

namespace tanktread::output {

/// Values of a field as they are written: one row per node.
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Named array at the nodes of a snapshot, shape (number of nodes, number of components).
struct Field {
  std::string name;
  Rows values;
};

/// Returns the fields that every snapshot has: positions `Points` and normals `Normals` of the surface with control net `net`. Normals give smooth
/// shading. The caller adds further fields.
std::vector<Field> shape_fields(const Nodes& nodes, const Net& net);

/// Returns the bytes of a snapshot's file: `/checkpoint` and `/VTKHDF` (version 1.0, UnstructuredGrid) with `fields` at all nodes.
std::string snapshot_file(const Checkpoint& checkpoint, const LagrangeMesh& mesh, std::span<const Field> fields);

/// The list `run.hdf.series`, with which ParaView opens all snapshots of a run as one time series:
/// {"file-series-version":"1.0","files":[{"name":"snapshot_000000.hdf","time":0.0}, ...]}.
class SnapshotSeries {
 public:
  explicit SnapshotSeries(std::filesystem::path directory);

  /// Returns the list for a resumed run: the readable snapshots in `directory` up to `step` whose run identifier (SnapshotLabel::run) is `run`.
  static SnapshotSeries resumed(std::filesystem::path directory, int step, const std::string& run);

  void add(int step, double time);  ///< adds or replaces the snapshot of a step
  void write() const;               ///< writes the list

 private:
  struct Entry {
    int step;
    double time;
  };
  std::filesystem::path directory_;
  std::vector<Entry> entries_;
};

}  // namespace tanktread::output
