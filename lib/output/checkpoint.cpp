#include "output/checkpoint.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <stdexcept>

#include "output/file.hpp"
#include "output/hdf.hpp"

namespace tanktread::output {
namespace {

namespace fs = std::filesystem;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

constexpr std::uint8_t kLagrangeQuadrilateral = 70;  // VTK_LAGRANGE_QUADRILATERAL

hdf::Shape shape_of(const Eigen::MatrixXd& matrix) { return {static_cast<hsize_t>(matrix.rows()), static_cast<hsize_t>(matrix.cols())}; }

void write_matrix(hid_t parent, const std::string& name, const Eigen::MatrixXd& matrix, const hdf::Shape& shape) {
  const RowMajor rows = matrix;
  hdf::write(parent, name, {rows.data(), static_cast<std::size_t>(rows.size())}, shape);
}

/// Fields of one component are one-dimensional: ParaView shows them as scalars.
void write_fields(hid_t parent, const std::string& group_name, const std::vector<Field>& fields) {
  const hdf::Id group = hdf::new_group(parent, group_name);
  for (const Field& field : fields) {
    const auto shape = shape_of(field.values);
    write_matrix(group, field.name, field.values, shape[1] == 1 ? hdf::Shape{shape[0]} : shape);
  }
}

void write_checkpoint(hid_t file, const Checkpoint& checkpoint) {
  const hdf::Id root = hdf::new_group(file, "checkpoint");
  const hdf::Id arrays = hdf::new_group(root, "arrays"), numbers = hdf::new_group(root, "numbers"), texts = hdf::new_group(root, "texts");
  for (const auto& [name, matrix] : checkpoint.arrays) write_matrix(arrays, name, matrix, shape_of(matrix));
  for (const auto& [name, number] : checkpoint.numbers) hdf::write(numbers, name, {&number, 1}, {});
  for (const auto& [name, text] : checkpoint.texts) hdf::write(texts, name, text);
}

void write_vtk(hid_t file, const Picture& picture) {
  using Count = std::array<std::int64_t, 1>;
  const LagrangeMesh& mesh = picture.mesh;
  const hdf::Id root = hdf::new_group(file, "VTKHDF");
  hdf::attribute(root, ".", "Version", std::array<std::int64_t, 2>{1, 0});
  hdf::attribute(root, ".", "Type", "UnstructuredGrid");
  hdf::write(root, "NumberOfPoints", Count{picture.points.rows()});
  hdf::write(root, "NumberOfCells", Count{static_cast<std::int64_t>(mesh.offsets.size()) - 1});
  hdf::write(root, "NumberOfConnectivityIds", Count{static_cast<std::int64_t>(mesh.connectivity.size())});
  hdf::write(root, "Connectivity", mesh.connectivity);
  hdf::write(root, "Offsets", mesh.offsets);
  hdf::write(root, "Types", std::vector<std::uint8_t>(mesh.offsets.size() - 1, kLagrangeQuadrilateral));
  write_matrix(root, "Points", picture.points, shape_of(picture.points));
  write_fields(root, "PointData", picture.point_fields);
  write_fields(root, "CellData", picture.cell_fields);
  write_fields(root, "FieldData", {});
}

/// Step of a snapshot's file name, or -1.
int step_of(const std::string& name) {
  constexpr std::string_view before = "snapshot_", after = ".hdf";
  if (!name.starts_with(before) || !name.ends_with(after)) return -1;
  int step = -1;
  const char *first = name.data() + before.size(), *last = name.data() + name.size() - after.size();
  const auto [end, error] = std::from_chars(first, last, step);
  return error == std::errc() && end == last ? step : -1;
}

}  // namespace

Picture picture(const Nodes& nodes, const Net& net) {
  Picture result{nodes.mesh(), nodes.values(net), {}, {}};
  result.point_fields.push_back({"Normals", nodes.normals(net)});
  return result;
}

std::string snapshot_name(int step) {
  char name[40];
  std::snprintf(name, sizeof name, "snapshot_%06d.hdf", step);
  return name;
}

void write_snapshot(const fs::path& path, const Checkpoint& checkpoint, const Picture& picture) {
  const hdf::Id file = hdf::new_file();
  write_checkpoint(file, checkpoint);
  write_vtk(file, picture);
  write_whole(path, hdf::image(file));
}

Checkpoint read_checkpoint(const fs::path& path) {
  const hdf::Id file = hdf::open(path);
  const hdf::Id root = hdf::group(file, "checkpoint");
  const hdf::Id arrays = hdf::group(root, "arrays"), numbers = hdf::group(root, "numbers"), texts = hdf::group(root, "texts");
  Checkpoint checkpoint;
  hdf::Shape shape;
  for (const auto& name : hdf::names(arrays)) {
    const auto values = hdf::read_doubles(arrays, name, shape);
    if (shape.size() != 2) throw std::runtime_error(path.string() + ": array " + name + " is no matrix");
    checkpoint.arrays[name] =
        Eigen::Map<const RowMajor>(values.data(), static_cast<Eigen::Index>(shape[0]), static_cast<Eigen::Index>(shape[1]));
  }
  for (const auto& name : hdf::names(numbers)) checkpoint.numbers[name] = hdf::read_doubles(numbers, name, shape).at(0);
  for (const auto& name : hdf::names(texts)) checkpoint.texts[name] = hdf::read_text(texts, name);
  return checkpoint;
}

std::vector<Snapshot> snapshots(const fs::path& directory) {
  std::vector<Snapshot> found;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(directory, error))
    if (const int step = step_of(entry.path().filename().string()); step >= 0) found.push_back({entry.path(), step});
  std::ranges::sort(found, {}, &Snapshot::step);
  return found;
}

std::optional<double> snapshot_time(const fs::path& path) {
  try {
    const hdf::Id file = hdf::open(path);
    hdf::Shape shape;
    const hdf::Id numbers = hdf::group(hdf::group(file, "checkpoint"), "numbers");
    const auto names = hdf::names(numbers);
    const bool of_the_picture = std::ranges::find(names, "picture time") != names.end();
    return hdf::read_doubles(numbers, of_the_picture ? "picture time" : "time", shape).at(0);
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

std::optional<Saved> newest_checkpoint(const fs::path& directory) {
  auto found = snapshots(directory);
  for (; !found.empty(); found.pop_back()) try {
      return Saved{found.back(), read_checkpoint(found.back().path)};
    } catch (const std::exception&) {
      continue;
    }
  return std::nullopt;
}

}  // namespace tanktread::output
