#include "record/files/checkpoint.hpp"

#include <algorithm>
#include <charconv>
#include <map>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "record/files/file.hpp"
#include "record/files/hdf.hpp"
#include "system/parallel/agreement.hpp"

namespace tanktread::output {

namespace {

namespace fs = std::filesystem;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Returns the step in a snapshot's file name, or -1 if `name` is not the file name of a snapshot.
int step_of(const std::string& name) {
  if (!name.starts_with(snapshot_start) || !name.ends_with(snapshot_end)) return -1;
  int step = -1;
  const char *first = name.data() + snapshot_start.size(), *last = name.data() + name.size() - snapshot_end.size();
  const auto [end, error] = std::from_chars(first, last, step);
  return error == std::errc() && end == last ? step : -1;
}

/// Returns the numbers of a checkpoint by name. The file stores all names in one text, one name per line.
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

std::string snapshot_name(int step) { return std::string(snapshot_start) + formatted("%06d", step) + std::string(snapshot_end); }

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
  const auto keys = hdf::attribute_names(file, "checkpoint");  // checkpoints of earlier versions have no checksum to check
  if (std::ranges::count(keys, "checksum") > 0 && hdf::read_attribute(file, "checkpoint", "checksum") != checksum(checkpoint))
    throw std::runtime_error(path.string() + ": the checkpoint is damaged, because its checksum differs");
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

std::optional<SnapshotLabel> snapshot_label(const fs::path& path) try {
  const hdf::Id file = hdf::open(path);
  const auto all = numbers(file);
  const bool named = std::ranges::count(hdf::datasets(file, "checkpoint/texts"), "run") > 0;
  const double time = all.contains("picture time") ? all.at("picture time") : all.at("time");
  return SnapshotLabel{time, named ? hdf::read_text(file, "checkpoint/texts/run") : ""};
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

fs::path newest_file(const fs::path& path) try {
  const auto saved = fs::is_directory(path) ? newest_checkpoint(path) : std::nullopt;
  return saved ? saved->file.path : path;
} catch (const std::exception&) {
  return path;
}

namespace {

/// Returns the name of the array with a block of a vector. Surfaces are numbered from 1.
std::string array_name(const std::string& vector, const coupling::Block& block) {
  return vector + " " + block.name + (block.on < 0 ? "" : " " + std::to_string(block.on + 1));
}

}  // namespace

void require_fit(bool fits) {
  if (!fits) throw UserError("the newest checkpoint does not fit its scene, because another version of tanktread wrote it: run the deck again");
}

void store(motion::TimeState state, Checkpoint& checkpoint) {
  checkpoint.numbers["time"] = state.time;
  checkpoint.numbers["proposed_step"] = state.step;
  checkpoint.numbers["slope_error"] = state.slope_error;
  checkpoint.numbers["frozen_time"] = state.frozen_time;
  checkpoint.numbers["slopes"] = static_cast<double>(state.history.size());
  checkpoint.numbers["secants"] = static_cast<double>(state.secants.pairs().size());
  checkpoint.arrays["memory"] = Eigen::Map<const Eigen::VectorXd>(state.memory.data(), static_cast<Eigen::Index>(state.memory.size()));
  Eigen::VectorXd times(state.places.size());
  for (std::size_t k = 0; k < state.places.size(); ++k) times[static_cast<Eigen::Index>(k)] = state.places[k].time;
  checkpoint.arrays["place times"] = times;
  motion::each_vector(state, [&](const std::string& name, const coupling::State& vector) {
    for (std::size_t k = 0; !vector.empty() && k < vector.layout()->blocks().size(); ++k)
      checkpoint.arrays[array_name(name, vector.layout()->blocks()[k])] = vector(coupling::BlockId{k});
  });
}

motion::TimeState stored_state(const Checkpoint& checkpoint) {
  motion::TimeState state;
  const auto number = [&](const char* name) { return checkpoint.numbers.at(name); };
  state.time = number("time");
  state.step = number("proposed_step");
  state.slope_error = number("slope_error");
  state.frozen_time = number("frozen_time");
  state.history.resize(static_cast<std::size_t>(number("slopes")));
  state.secants = coupling::Secants(std::vector<coupling::State>(static_cast<std::size_t>(number("secants"))));
  const Eigen::MatrixXd &memory = checkpoint.arrays.at("memory"), &times = checkpoint.arrays.at("place times");
  state.memory.assign(memory.data(), memory.data() + memory.size());
  for (Eigen::Index k = 0; k < times.size(); ++k) state.places.push_back({times(k), {}});
  return state;
}

void read_vectors(const Checkpoint& checkpoint, const std::shared_ptr<const coupling::Layout>& layout, motion::TimeState& state) {
  motion::each_vector(state, [&](const std::string& name, coupling::State& vector) {
    const std::span<const coupling::Block> blocks = layout->blocks();
    if ((name == "frozen" || name == "direction") && !checkpoint.arrays.contains(array_name(name, blocks.front()))) return;
    vector = coupling::State(layout);
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      const auto rows = checkpoint.arrays.find(array_name(name, blocks[k]));
      require_fit(rows != checkpoint.arrays.end() && rows->second.rows() == blocks[k].rows && rows->second.cols() == blocks[k].components);
      vector(coupling::BlockId{k}) = rows->second;
    }
  });
}

Net stored_shapes(const Checkpoint& checkpoint) {
  Net all;
  for (int k = 0;; ++k) {
    const auto shape = checkpoint.arrays.find(array_name("x", {"shape", k}));
    if (shape == checkpoint.arrays.end()) break;
    all.conservativeResize(all.rows() + shape->second.rows(), 3);
    all.bottomRows(shape->second.rows()) = shape->second;
  }
  if (const auto x = checkpoint.arrays.find("x"); all.rows() == 0 && x != checkpoint.arrays.end()) return x->second;
  return all;
}

bool equal_on_all_ranks(const motion::TimeState& state) {
  Checkpoint checkpoint;
  store(state, checkpoint);
  const std::string mine = checksum(checkpoint);
  std::vector<double> digits(mine.begin(), mine.end());
  coupling::take_first(digits);
  return coupling::largest(!std::ranges::equal(mine, digits)) == 0;
}

}  // namespace tanktread::output
