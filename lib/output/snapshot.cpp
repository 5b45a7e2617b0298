#include "output/snapshot.hpp"

#include <array>
#include <cstdint>

#include "output/hdf.hpp"

namespace tanktread::output {
namespace {

namespace fs = std::filesystem;

constexpr std::uint8_t lagrange_quadrilateral = 70;  // VTK_LAGRANGE_QUADRILATERAL
constexpr const char* points = "Points";             // the one field that stands beside the others' group

void write(hid_t parent, const std::string& name, const Rows& rows, std::size_t dimensions = 2) {
  hdf::Shape shape{static_cast<hsize_t>(rows.rows()), static_cast<hsize_t>(rows.cols())};
  shape.resize(dimensions);
  hdf::write(parent, name, {rows.data(), static_cast<std::size_t>(rows.size())}, shape);
}

void write(hid_t root, const Checkpoint& checkpoint) {
  const hdf::Id arrays = hdf::new_group(root, "arrays"), numbers = hdf::new_group(root, "numbers"), texts = hdf::new_group(root, "texts");
  for (const auto& [name, matrix] : checkpoint.arrays) write(arrays, name, matrix);
  for (const auto& [name, number] : checkpoint.numbers) hdf::write(numbers, name, {&number, 1}, {});
  for (const auto& [name, text] : checkpoint.texts) hdf::write(texts, name, text);
  hdf::attribute(root, ".", "checksum", checksum(checkpoint));
}

void write(hid_t root, const LagrangeMesh& mesh) {
  using Count = std::array<std::int64_t, 1>;
  hdf::attribute(root, ".", "Version", std::array<std::int64_t, 2>{1, 0});
  hdf::attribute(root, ".", "Type", "UnstructuredGrid");
  hdf::write(root, "NumberOfPoints", Count{static_cast<std::int64_t>(mesh.sites.size())});
  hdf::write(root, "NumberOfCells", Count{static_cast<std::int64_t>(mesh.offsets.size()) - 1});
  hdf::write(root, "NumberOfConnectivityIds", Count{static_cast<std::int64_t>(mesh.connectivity.size())});
  hdf::write(root, "Connectivity", mesh.connectivity);
  hdf::write(root, "Offsets", mesh.offsets);
  hdf::write(root, "Types", std::vector<std::uint8_t>(mesh.offsets.size() - 1, lagrange_quadrilateral));
  for (const char* empty : {"CellData", "FieldData"}) hdf::new_group(root, empty);
}

}  // namespace

std::vector<Field> picture(const Nodes& nodes, const Net& net, NodeRange range) {
  return {{points, nodes.values(net, range)}, {"Normals", nodes.normals(net, range)}};
}

void write_snapshot(const fs::path& path, const Checkpoint& checkpoint, const LagrangeMesh& mesh, std::span<const Field> fields,
                    Durable durable) {
  const hdf::Id file = hdf::new_file();
  {
    const hdf::Id saved = hdf::new_group(file, "checkpoint"), drawn = hdf::new_group(file, "VTKHDF"),
                  at_points = hdf::new_group(drawn, "PointData");
    write(saved, checkpoint);
    write(drawn, mesh);
    for (const Field& field : fields)  // ParaView shows those of one dimension as scalars
      write(field.name == points ? drawn : at_points, field.name, field.values, field.values.cols() > 1 ? 2 : 1);
  }
  write_whole(path, hdf::image(file), durable);
}

}  // namespace tanktread::output
