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

/// What the first process writes behind what HDF5 does.
struct Behind {
  std::int64_t place;
  std::string_view bytes;
};

template <class Number>
std::string_view bytes_of(const Number* numbers, std::size_t n) {
  return {reinterpret_cast<const char*>(numbers), n * sizeof(Number)};
}

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
  std::vector<Rows> arrays;
  arrays.reserve(checkpoint.arrays.size());
  std::vector<Behind> behind;
  {
    const hdf::Id saved = hdf::new_group(draft, "checkpoint"), drawn = hdf::new_group(draft, "VTKHDF");
    const hdf::Id in_arrays = hdf::new_group(saved, "arrays"), in_points = hdf::new_group(drawn, "PointData");
    write_small(saved, checkpoint);
    write_small(drawn, mesh);
    for (const auto& [name, matrix] : checkpoint.arrays) {
      const Rows& rows = arrays.emplace_back(matrix);
      const hdf::Shape shape{static_cast<hsize_t>(rows.rows()), static_cast<hsize_t>(rows.cols())};
      behind.push_back({draft.room(in_arrays, name, shape), bytes_of(rows.data(), static_cast<std::size_t>(rows.size()))});
    }
    for (const auto& [name, whole] : {std::pair("Connectivity", &mesh.connectivity), std::pair("Offsets", &mesh.offsets)})
      behind.push_back({draft.room(drawn, name, {whole->size()}, H5T_NATIVE_INT64), bytes_of(whole->data(), whole->size())});
    for (const Field& field : fields) {
      hdf::Shape shape{mesh.sites.size()};
      if (field.values.cols() > 1) shape.push_back(static_cast<hsize_t>(field.values.cols()));  // ParaView shows one-dimensional ones as scalars
      places.push_back(draft.room(field.name == points ? drawn : in_points, field.name, shape));
    }
  }
  const hdf::Draft::Bytes bytes = draft.close();
  Unfinished file(path, Unfinished::Begin::anew);
  file.write(0, bytes.first);
  for (const Behind& array : behind) file.write(static_cast<std::uint64_t>(array.place), array.bytes);
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
