#pragma once
// Writing a saved step: one closed file, at once an exact checkpoint and a picture for ParaView.

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "output/checkpoint.hpp"
#include "output/file.hpp"
#include "output/nodes.hpp"

namespace tanktread::output {

/// What is written of a field: a row a node.
using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A named array at some nodes of a picture, shape (nodes, k).
struct Field {
  std::string name;
  Rows values;
};

/// Places and normals of `net`: `Points`, which every picture has, and `Normals`, which give smooth shading. Further fields are the caller's to add.
std::vector<Field> picture(const Nodes& nodes, const Net& net, NodeRange range);

/// Begins a snapshot beside `path`: `/checkpoint` and `/VTKHDF` (version 1.0, UnstructuredGrid) but for what is long. Returns where in the file the
/// first number belongs of the cells' two arrays, of each of the checkpoint, of each field. `fields`: of any nodes, for their names and their numbers
/// of components. Throws RunFailure when the disk refuses.
std::vector<std::int64_t> lay_out_snapshot(const std::filesystem::path& path, const Checkpoint& checkpoint, const LagrangeMesh& mesh,
                                           std::span<const Field> fields);

/// How many those are.
inline std::size_t n_places(const Checkpoint& checkpoint, std::span<const Field> fields) {
  return 2 + checkpoint.arrays.size() + fields.size();
}

/// A snapshot that has been laid out, while it is filled: by any number of processes, each with other nodes, one with the checkpoint, one with the
/// cells. When all have closed theirs, `finish` (file.hpp) puts it in its place. Throws as the former does.
class SnapshotParts {
 public:
  SnapshotParts(const std::filesystem::path& path, std::vector<std::int64_t> places);
  void write(std::span<const Field> fields, NodeRange range);
  void write(const Checkpoint& checkpoint);  ///< by the process that laid it out, for the sake of the checksum
  void write(const LagrangeMesh& mesh);
  void close() { file_.close(); }

 private:
  Unfinished file_;
  std::vector<std::int64_t> places_;
};

/// All of it by one process; `fields` of all nodes.
void write_snapshot(const std::filesystem::path& path, const Checkpoint& checkpoint, const LagrangeMesh& mesh, std::span<const Field> fields);

}  // namespace tanktread::output
