#pragma once
// `run.hdf.series`: the list with which ParaView opens all snapshots of a run behind one time slider.

#include <filesystem>
#include <string>
#include <vector>

namespace tanktread::output {

/// {"file-series-version":"1.0","files":[{"name":"snapshot_000000.hdf","time":0.0}, ...]}, written whole after every snapshot.
class SnapshotSeries {
 public:
  explicit SnapshotSeries(std::filesystem::path directory);

  /// The list that a resumed run goes on with: snapshots up to `step` that can be read and are of `run` (Picture).
  static SnapshotSeries resumed(std::filesystem::path directory, int step, const std::string& run);

  /// Adds the snapshot of a step, which stands in the directory already, and rewrites the list.
  void add(int step, double time);

 private:
  struct Entry {
    int step;
    double time;
  };
  std::filesystem::path directory_;
  std::vector<Entry> entries_;
};

}  // namespace tanktread::output
