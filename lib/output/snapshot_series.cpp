#include "output/snapshot_series.hpp"

#include <algorithm>
#include <utility>

#include "output/checkpoint.hpp"
#include "output/file.hpp"
#include "output/text.hpp"

namespace tanktread::output {

namespace fs = std::filesystem;

SnapshotSeries::SnapshotSeries(fs::path directory) : directory_(std::move(directory)) {}

SnapshotSeries SnapshotSeries::resumed(fs::path directory, int step, const std::string& run) {
  SnapshotSeries series(std::move(directory));
  for (const Snapshot& snapshot : snapshots(series.directory_))
    if (const auto picture = snapshot.step <= step ? pictured(snapshot.path) : std::nullopt; picture && picture->run == run)
      series.entries_.push_back({snapshot.step, picture->time});
  return series;
}

void SnapshotSeries::add(int step, double time) {
  std::erase_if(entries_, [step](const Entry& entry) { return entry.step == step; });
  entries_.push_back({step, time});
  std::string text = "{\"file-series-version\":\"1.0\",\"files\":[";
  for (const Entry& entry : entries_) {
    text += &entry == entries_.data() ? "\n" : ",\n";
    text += "{\"name\":" + in_quotes(snapshot_name(entry.step)) + ",\"time\":" + number(entry.time) + "}";
  }
  write_whole(directory_ / "run.hdf.series", text + "\n]}\n");
}

}  // namespace tanktread::output
