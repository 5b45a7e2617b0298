#include "output/snapshot.hpp"

#include <array>
#include <utility>

#include "output/hdf.hpp"

namespace tanktread::output {
namespace {

namespace fs = std::filesystem;

constexpr std::uint8_t lagrange_quadrilateral = 70;  // VTK_LAGRANGE_QUADRILATERAL
constexpr const char* points = "Points";             // the one field that stands beside the others' group

void write_checkpoint(hid_t file, const Checkpoint& checkpoint) {
  const hdf::Id root = hdf::new_group(file, "checkpoint");
  const hdf::Id arrays = hdf::new_group(root, "arrays"), numbers = hdf::new_group(root, "numbers"), texts = hdf::new_group(root, "texts");
  for (const auto& [name, matrix] : checkpoint.arrays) {
    const Rows rows = matrix;
    hdf::write(arrays, name, {rows.data(), static_cast<std::size_t>(rows.size())},
               {static_cast<hsize_t>(rows.rows()), static_cast<hsize_t>(rows.cols())});
  }
  for (const auto& [name, number] : checkpoint.numbers) hdf::write(numbers, name, {&number, 1}, {});
  for (const auto& [name, text] : checkpoint.texts) hdf::write(texts, name, text);
  hdf::attribute(root, ".", "checksum", checksum(checkpoint));
}

void write_cells(hid_t root, const LagrangeMesh& mesh) {
  using Count = std::array<std::int64_t, 1>;
  hdf::attribute(root, ".", "Version", std::array<std::int64_t, 2>{1, 0});
  hdf::attribute(root, ".", "Type", "UnstructuredGrid");
  hdf::write(root, "NumberOfPoints", Count{static_cast<std::int64_t>(mesh.sites.size())});
  hdf::write(root, "NumberOfCells", Count{static_cast<std::int64_t>(mesh.offsets.size()) - 1});
  hdf::write(root, "NumberOfConnectivityIds", Count{static_cast<std::int64_t>(mesh.connectivity.size())});
  hdf::write(root, "Connectivity", mesh.connectivity);
  hdf::write(root, "Offsets", mesh.offsets);
  hdf::write(root, "Types", std::vector<std::uint8_t>(mesh.offsets.size() - 1, lagrange_quadrilateral));
}

}  // namespace

std::vector<Field> picture(const Nodes& nodes, const Net& net, NodeRange range) {
  return {{points, nodes.values(net, range)}, {"Normals", nodes.normals(net, range)}};
}

std::vector<std::int64_t> lay_out_snapshot(const fs::path& path, const Checkpoint& checkpoint, const LagrangeMesh& mesh,
                                           std::span<const Field> fields) {
  hdf::Draft draft;
  std::vector<std::int64_t> places;
  {
    write_checkpoint(draft, checkpoint);
    const hdf::Id root = hdf::new_group(draft, "VTKHDF"), at_points = hdf::new_group(root, "PointData");
    for (const char* empty : {"CellData", "FieldData"}) hdf::new_group(root, empty);
    write_cells(root, mesh);
    for (const Field& field : fields) {
      hdf::Shape shape{mesh.sites.size()};
      if (field.values.cols() > 1) shape.push_back(static_cast<hsize_t>(field.values.cols()));  // ParaView shows one-dimensional ones as scalars
      places.push_back(draft.room(field.name == points ? root : at_points, field.name, shape));
    }
  }
  const hdf::Draft::Bytes bytes = draft.close();
  Unfinished file(path, Unfinished::Begin::anew);
  file.write(0, bytes.first);
  file.resize(bytes.size);
  file.close();
  return places;
}

SnapshotFields::SnapshotFields(const fs::path& path, std::vector<std::int64_t> places)
    : file_(path, Unfinished::Begin::with_what_is_there), places_(std::move(places)) {}

void SnapshotFields::write(std::span<const Field> fields, NodeRange range) {
  for (std::size_t k = 0; k < fields.size(); ++k) {
    const Rows& values = fields[k].values;
    const auto before = static_cast<std::int64_t>(sizeof(double)) * range.begin * values.cols();
    file_.write(static_cast<std::uint64_t>(places_[k] + before), std::span(values.data(), static_cast<std::size_t>(values.size())));
  }
}

void write_snapshot(const fs::path& path, const Checkpoint& checkpoint, const LagrangeMesh& mesh, std::span<const Field> fields) {
  SnapshotFields file(path, lay_out_snapshot(path, checkpoint, mesh, fields));
  file.write(fields, {0, static_cast<int>(mesh.sites.size())});
  file.close();
  finish(path);
}

}  // namespace tanktread::output
