#include "output/snapshot.hpp"

#include <array>
#include <string_view>
#include <utility>

#include "output/hdf.hpp"

namespace tanktread::output {
namespace {

namespace fs = std::filesystem;

constexpr std::uint8_t lagrange_quadrilateral = 70;  // VTK_LAGRANGE_QUADRILATERAL
constexpr const char* points = "Points";             // the one field that stands beside the others' group

std::span<const double> numbers(const Rows& rows) { return {rows.data(), static_cast<std::size_t>(rows.size())}; }

void write_small(hid_t root, const Checkpoint& checkpoint) {
  const hdf::Id numbers = hdf::new_group(root, "numbers"), texts = hdf::new_group(root, "texts");
  for (const auto& [name, number] : checkpoint.numbers) hdf::write(numbers, name, {&number, 1}, {});
  for (const auto& [name, text] : checkpoint.texts) hdf::write(texts, name, text);
  hdf::attribute(root, ".", "checksum", checksum(checkpoint));
}

void write_small(hid_t root, const LagrangeMesh& mesh) {
  using Count = std::array<std::int64_t, 1>;
  hdf::attribute(root, ".", "Version", std::array<std::int64_t, 2>{1, 0});
  hdf::attribute(root, ".", "Type", "UnstructuredGrid");
  hdf::write(root, "NumberOfPoints", Count{static_cast<std::int64_t>(mesh.sites.size())});
  hdf::write(root, "NumberOfCells", Count{static_cast<std::int64_t>(mesh.offsets.size()) - 1});
  hdf::write(root, "NumberOfConnectivityIds", Count{static_cast<std::int64_t>(mesh.connectivity.size())});
  hdf::write(root, "Types", std::vector<std::uint8_t>(mesh.offsets.size() - 1, lagrange_quadrilateral));
  for (const char* empty : {"CellData", "FieldData"}) hdf::new_group(root, empty);
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
    const hdf::Id saved = hdf::new_group(draft, "checkpoint"), drawn = hdf::new_group(draft, "VTKHDF");
    const hdf::Id in_arrays = hdf::new_group(saved, "arrays"), in_points = hdf::new_group(drawn, "PointData");
    write_small(saved, checkpoint);
    write_small(drawn, mesh);
    places.push_back(draft.room(drawn, "Connectivity", {mesh.connectivity.size()}, H5T_NATIVE_INT64));
    places.push_back(draft.room(drawn, "Offsets", {mesh.offsets.size()}, H5T_NATIVE_INT64));
    for (const auto& [name, matrix] : checkpoint.arrays)
      places.push_back(draft.room(in_arrays, name, {static_cast<hsize_t>(matrix.rows()), static_cast<hsize_t>(matrix.cols())}));
    for (const Field& field : fields) {
      hdf::Shape shape{mesh.sites.size()};
      if (field.values.cols() > 1) shape.push_back(static_cast<hsize_t>(field.values.cols()));  // ParaView shows one-dimensional ones as scalars
      places.push_back(draft.room(field.name == points ? drawn : in_points, field.name, shape));
    }
  }
  const hdf::Draft::Bytes bytes = draft.close();
  Unfinished file(path, Unfinished::Begin::anew);
  file.write(0, bytes.first);
  file.resize(bytes.size);
  file.close();
  return places;
}

SnapshotParts::SnapshotParts(const fs::path& path, std::vector<std::int64_t> places)
    : file_(path, Unfinished::Begin::with_what_is_there), places_(std::move(places)) {}

void SnapshotParts::write(std::span<const Field> fields, NodeRange range) {
  const std::int64_t* place = places_.data() + places_.size() - fields.size();
  for (const Field& field : fields) {
    const auto before = static_cast<std::int64_t>(sizeof(double)) * range.begin * field.values.cols();
    file_.write(static_cast<std::uint64_t>(*place++ + before), numbers(field.values));
  }
}

void SnapshotParts::write(const Checkpoint& checkpoint) {
  const std::int64_t* place = places_.data() + 2;
  for (const auto& [name, matrix] : checkpoint.arrays) file_.write(static_cast<std::uint64_t>(*place++), numbers(Rows(matrix)));
}

void SnapshotParts::write(const LagrangeMesh& mesh) {
  const std::int64_t* place = places_.data();
  for (const auto* whole : {&mesh.connectivity, &mesh.offsets})
    file_.write(static_cast<std::uint64_t>(*place++),
                std::string_view(reinterpret_cast<const char*>(whole->data()), sizeof(std::int64_t) * whole->size()));
}

void write_snapshot(const fs::path& path, const Checkpoint& checkpoint, const LagrangeMesh& mesh, std::span<const Field> fields) {
  SnapshotParts file(path, lay_out_snapshot(path, checkpoint, mesh, fields));
  file.write(checkpoint);
  file.write(mesh);
  file.write(fields, {0, static_cast<int>(mesh.sites.size())});
  file.close();
  finish(path);
}

}  // namespace tanktread::output
