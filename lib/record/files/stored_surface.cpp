#include "record/files/stored_surface.hpp"

#include <stdexcept>

#include "base/errors.hpp"
#include "record/files/checkpoint.hpp"
#include "record/files/file.hpp"
#include "record/files/hdf.hpp"

namespace tanktread::output {

namespace fs = std::filesystem;

StoredSurface read_surface(const fs::path& snapshot) try {
  const hdf::Id file = hdf::open(snapshot);
  hdf::Shape shape;
  const std::vector<double> points = hdf::read_doubles(file, "VTKHDF/Points", shape);
  const std::vector<double> nodes = hdf::read_doubles(file, "VTKHDF/Connectivity", shape), offsets = hdf::read_doubles(file, "VTKHDF/Offsets", shape);
  StoredSurface surface;
  surface.points = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>>(points.data(),
                                                                                               static_cast<Eigen::Index>(points.size() / 3), 3);
  for (std::size_t k = 0; k + 1 < offsets.size(); ++k)
    surface.cells.emplace_back(nodes.begin() + static_cast<std::ptrdiff_t>(offsets[k]), nodes.begin() + static_cast<std::ptrdiff_t>(offsets[k + 1]));
  return surface;
} catch (const std::runtime_error& error) {
  throw RunFailure("the snapshot " + snapshot.string() + " cannot be read: " + error.what());
}

std::vector<std::pair<std::string, double>> snapshot_times(const fs::path& directory) {
  std::vector<std::pair<std::string, double>> found;
  for (const Snapshot& one : snapshots(directory))
    if (const auto label = snapshot_label(one.path)) found.emplace_back(one.path.filename(), label->time);
  return found;
}

void add_field(const fs::path& from, const fs::path& to, const std::string& name, std::span<const double> values) try {
  const hdf::Id file = hdf::open_copy(from);
  hdf::write(file, "VTKHDF/PointData/" + name, values, {values.size()});
  write_whole(to, hdf::image(file));
} catch (const RunFailure&) {
  throw;
} catch (const std::runtime_error& error) {
  throw RunFailure("the snapshot " + to.string() + " cannot be written: " + error.what());
}

}  // namespace tanktread::output
