#include "record/files/snapshot.hpp"

#include <array>
#include <cstdint>
#include <utility>

#include "deck/words.hpp"
#include "record/files/hdf.hpp"

namespace tanktread::output {
namespace {

namespace fs = std::filesystem;

constexpr std::uint8_t lagrange_quadrilateral = 70;  // VTK_LAGRANGE_QUADRILATERAL
constexpr const char* points = "Points";             // name of the positions; unlike other fields, they are not in the group PointData

void write(hid_t file, const std::string& name, const Rows& rows, std::size_t dimensions = 2) {
  hdf::Shape shape{static_cast<hsize_t>(rows.rows()), static_cast<hsize_t>(rows.cols())};
  shape.resize(dimensions);
  hdf::write(file, name, {rows.data(), static_cast<std::size_t>(rows.size())}, shape);
}

void write(hid_t file, const Checkpoint& checkpoint) {
  const hdf::Id group = hdf::write_group(file, "checkpoint");
  for (const auto& [name, matrix] : checkpoint.arrays) write(file, "checkpoint/arrays/" + name, matrix);
  std::string names;  // names of the entries of checkpoint.numbers, one per line; one dataset per entry would take longer to write than all fields
  std::vector<double> numbers;
  for (const auto& [name, number] : checkpoint.numbers) names += name + "\n", numbers.push_back(number);
  hdf::write(file, "checkpoint/numbers", numbers, {numbers.size()});
  hdf::write(file, "checkpoint/names of numbers", names);
  for (const auto& [name, text] : checkpoint.texts) hdf::write(file, "checkpoint/texts/" + name, text);
  hdf::attribute(group, "checksum", checksum(checkpoint));
}

void write(hid_t file, const LagrangeMesh& mesh) {
  using Count = std::array<std::int64_t, 1>;
  const hdf::Id grid = hdf::write_group(file, "VTKHDF");
  for (const char* group : {"PointData", "CellData", "FieldData"}) hdf::write_group(grid, group);
  hdf::attribute(grid, "Version", std::array<std::int64_t, 2>{1, 0});
  hdf::attribute(grid, "Type", "UnstructuredGrid");
  hdf::write(file, "VTKHDF/NumberOfPoints", Count{static_cast<std::int64_t>(mesh.sites.size())});
  hdf::write(file, "VTKHDF/NumberOfCells", Count{static_cast<std::int64_t>(mesh.offsets.size()) - 1});
  hdf::write(file, "VTKHDF/NumberOfConnectivityIds", Count{static_cast<std::int64_t>(mesh.connectivity.size())});
  hdf::write(file, "VTKHDF/Connectivity", mesh.connectivity);
  hdf::write(file, "VTKHDF/Offsets", mesh.offsets);
  hdf::write(file, "VTKHDF/Types", std::vector<std::uint8_t>(mesh.offsets.size() - 1, lagrange_quadrilateral));
}

}  // namespace

std::vector<Field> shape_fields(const Nodes& nodes, const Net& net) { return {{points, nodes.values(net)}, {"Normals", nodes.normals(net)}}; }

std::string snapshot_file(const Checkpoint& checkpoint, const LagrangeMesh& mesh, std::span<const Field> fields) {
  const hdf::Id file = hdf::new_file();
  write(file, checkpoint);
  write(file, mesh);
  for (const Field& field : fields)  // a field with one component is one-dimensional, because ParaView then shows it as a scalar
    write(file, (field.name == points ? "VTKHDF/" : "VTKHDF/PointData/") + field.name, field.values, field.values.cols() > 1 ? 2 : 1);
  return std::string(hdf::image(file));
}

SnapshotSeries::SnapshotSeries(fs::path directory) : directory_(std::move(directory)) {}

SnapshotSeries SnapshotSeries::resumed(fs::path directory, int step, const std::string& run) {
  SnapshotSeries series(std::move(directory));
  for (const Snapshot& snapshot : snapshots(series.directory_))
    if (const auto label = snapshot.step <= step ? snapshot_label(snapshot.path) : std::nullopt; label && label->run == run)
      series.entries_.push_back({snapshot.step, label->time});
  return series;
}

void SnapshotSeries::add(int step, double time) {
  // Results::save() may have failed after it called add(), and is then called again for the same step.
  std::erase_if(entries_, [step](const Entry& entry) { return entry.step == step; });
  entries_.push_back({step, time});
}

void SnapshotSeries::write() const {
  std::string text = "{\"file-series-version\":\"1.0\",\"files\":[";
  for (const Entry& entry : entries_) {
    text += &entry == entries_.data() ? "\n" : ",\n";
    text += "{\"name\":\"" + snapshot_name(entry.step) + "\",\"time\":" + deck::real_text(entry.time) + "}";
  }
  write_whole(directory_ / snapshot_list_file, text + "\n]}\n");
}

}  // namespace tanktread::output
