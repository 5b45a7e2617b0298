#include "record/files/checkpoint.hpp"

#include <algorithm>
#include <charconv>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "record/files/checksum.hpp"
#include "record/files/file.hpp"
#include "record/files/hdf.hpp"

namespace tanktread::output {
namespace {

namespace fs = std::filesystem;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Step of a snapshot's file name, or -1.
int step_of(const std::string& name) {
  constexpr std::string_view before = "snapshot_", after = ".hdf";
  if (!name.starts_with(before) || !name.ends_with(after)) return -1;
  int step = -1;
  const char *first = name.data() + before.size(), *last = name.data() + name.size() - after.size();
  const auto [end, error] = std::from_chars(first, last, step);
  return error == std::errc() && end == last ? step : -1;
}

/// The numbers of a checkpoint by their names, which stand one a line.
std::map<std::string, double> numbers(const hdf::Id& file) {
  hdf::Shape shape;
  const std::vector<double> values = hdf::read_doubles(file, "checkpoint/numbers", shape);
  std::istringstream names(hdf::read_text(file, "checkpoint/names of numbers"));
  std::map<std::string, double> by_name;
  std::string name;
  for (const double value : values) {
    if (!std::getline(names, name)) throw std::runtime_error("a number of the checkpoint has no name");
    by_name[name] = value;
  }
  return by_name;
}

}  // namespace

std::string snapshot_name(int step) { return formatted("snapshot_%06d.hdf", step); }

std::string checksum(const Checkpoint& checkpoint) {
  Checksum sum;
  for (const auto& [name, matrix] : checkpoint.arrays) {
    sum.add(name);
    sum.add(static_cast<std::uint64_t>(matrix.rows()));
    sum.add(static_cast<std::uint64_t>(matrix.cols()));
    for (Eigen::Index k = 0; k < matrix.size(); ++k) sum.add(matrix.data()[k]);
  }
  for (const auto& [name, number] : checkpoint.numbers) sum.add(name), sum.add(number);
  for (const auto& [name, text] : checkpoint.texts) sum.add(name), sum.add(text);
  return sum.digits();
}

Checkpoint read_checkpoint(const fs::path& path) {
  const hdf::Id file = hdf::open(path);
  Checkpoint checkpoint;
  hdf::Shape shape;
  for (const auto& name : hdf::datasets(file, "checkpoint/arrays")) {
    const auto values = hdf::read_doubles(file, "checkpoint/arrays/" + name, shape);
    if (shape.size() != 2) throw std::runtime_error(path.string() + ": array " + name + " is no matrix");
    checkpoint.arrays[name] =
        Eigen::Map<const RowMajor>(values.data(), static_cast<Eigen::Index>(shape[0]), static_cast<Eigen::Index>(shape[1]));
  }
  checkpoint.numbers = numbers(file);
  for (const auto& name : hdf::datasets(file, "checkpoint/texts")) checkpoint.texts[name] = hdf::read_text(file, "checkpoint/texts/" + name);
  const auto keys = hdf::attribute_names(file, "checkpoint");  // versions before had no checksum
  if (std::ranges::count(keys, "checksum") > 0 && hdf::read_attribute(file, "checkpoint", "checksum") != checksum(checkpoint))
    throw std::runtime_error(path.string() + ": the checkpoint is not as it was written");
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

std::optional<Picture> pictured(const fs::path& path) try {
  const hdf::Id file = hdf::open(path);
  const auto all = numbers(file);
  const bool named = std::ranges::count(hdf::datasets(file, "checkpoint/texts"), "run") > 0;
  return Picture{all.contains("picture time") ? all.at("picture time") : all.at("time"), named ? hdf::read_text(file, "checkpoint/texts/run") : ""};
} catch (const std::exception&) {
  return std::nullopt;
}

std::optional<Saved> newest_checkpoint(const fs::path& directory) {
  std::vector<Damaged> damaged;
  for (auto found = snapshots(directory); !found.empty(); found.pop_back()) try {
      return Saved{found.back(), read_checkpoint(found.back().path), std::move(damaged)};
    } catch (const RunFailure&) {
      throw;  // the next attempt may succeed
    } catch (const std::exception& error) {
      check_readable(found.back().path);
      damaged.push_back({found.back().path, error.what()});
    }
  return std::nullopt;
}

}  // namespace tanktread::output
