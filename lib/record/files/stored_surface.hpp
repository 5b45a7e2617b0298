#pragma once
// Surface of a snapshot, read from its mesh for ParaView, and fields that are added to a snapshot later.

#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "base/types.hpp"

namespace tanktread::output {

/// Surface in a snapshot: Lagrange cells, which hold the polynomials of the elements exactly.
struct StoredSurface {
  Net points;                           ///< positions of the nodes
  std::vector<std::vector<int>> cells;  ///< indices of the (p + 1)^2 nodes of each cell of degree p, in the order of `node_order`
};

/// Reads the surface of a snapshot. Throws RunFailure if the file cannot be read.
StoredSurface read_surface(const std::filesystem::path& snapshot);

/// Returns the names and times of all readable snapshots in a directory, in the order of their steps.
std::vector<std::pair<std::string, double>> snapshot_times(const std::filesystem::path& directory);

/// Copies the snapshot `from` to `to` and adds the field `name`, one value per node. Throws RunFailure if reading or writing fails.
void add_field(const std::filesystem::path& from, const std::filesystem::path& to, const std::string& name, std::span<const double> values);

}  // namespace tanktread::output
