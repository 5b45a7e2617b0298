#pragma once
// Writing a saved step: one closed file, at once an exact checkpoint and a picture for ParaView.

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

/// Writes the file in one step (write_whole): `/checkpoint` and `/VTKHDF` (version 1.0, UnstructuredGrid) with `fields` at all nodes. Serial: on
/// several ranks the first one writes what all have gathered. Throws RunFailure when the disk refuses.
void write_snapshot(const std::filesystem::path& path, const Checkpoint& checkpoint, const LagrangeMesh& mesh,
                    std::span<const Field> fields, Durable durable = Durable::no);

}  // namespace tanktread::output
