#include <filesystem>
#include <string>
#include <vector>

#include <sys/stat.h>

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "record/files/checkpoint.hpp"
#include "record/files/file.hpp"
#include "record/files/stored_surface.hpp"
#include "scratch.hpp"

namespace tanktread::output {
namespace {

namespace fs = std::filesystem;

/// Creates an empty file and its folder, and returns its path.
fs::path touched(const fs::path& path) {
  fs::create_directories(path.parent_path());
  std::ofstream(path).close();
  return path;
}

TEST(Directories, OfRunsLoseTheirResultsOnly) {
  const Scratch scratch;
  std::vector<fs::path> results;
  for (const std::string& name : {snapshot_name(12), snapshot_name(12) + ".damaged.2", snapshot_name(13) + ".part"})
    results.push_back(touched(scratch / name));
  for (const RunFile& one : run_files)
    for (const char* end : {"", ".part"}) results.push_back(touched(scratch / (one.name + std::string(end))));
  const std::vector<fs::path> others = {touched(scratch / failure_file), touched(scratch / "notes.txt"), touched(scratch / "level_0" / failure_file)};
  EXPECT_THROW(check_vacant(scratch.path()), UserError);
  start_directory(scratch.path());
  EXPECT_NO_THROW(check_vacant(scratch.path()));
  for (const fs::path& one : results) EXPECT_FALSE(fs::exists(one)) << one;
  for (const fs::path& one : others) EXPECT_TRUE(fs::exists(one)) << one;  // without `ladder_file` the folder is not that of a level
}

TEST(Directories, AreVacantIfTheyHoldOnlyFilesThatAreWrittenBeforeTheFirstRow) {
  for (const RunFile& one : run_files) {
    const Scratch scratch;
    touched(scratch / one.name);
    if (one.before_rows)
      EXPECT_NO_THROW(check_vacant(scratch.path())) << one.name;
    else
      EXPECT_THROW(check_vacant(scratch.path()), UserError) << one.name;
  }
}

TEST(Directories, AreFlushedWithoutAFileThatARunDoesNotWrite) {
  const Scratch scratch;
  touched(scratch / record_file), touched(scratch / snapshot_name(0)), touched(scratch / "outline.csv");
  ASSERT_EQ(mkfifo((scratch / channel_file).c_str(), 0600), 0);  // no regular file
  fs::create_symlink(scratch / "nowhere", scratch / summary_file);
  EXPECT_NO_THROW(sync_results(scratch.path(), {"outline.csv", "absent.iga"}));
  EXPECT_THROW(sync_results(scratch / "nowhere", {}), RunFailure);
}

TEST(Directories, OfLaddersLoseTheResultsAndFailuresOfTheirLevelsOnly) {
  const Scratch scratch;
  touched(scratch / ladder_file);
  const std::vector<fs::path> results = {touched(scratch / level_folder("0") / failure_file),
                                         touched(scratch / level_folder("2_time") / record_file)};
  const std::vector<fs::path> others = {touched(scratch / "mine" / failure_file), touched(scratch / "mine" / record_file),
                                        touched(scratch / "level_of_water" / failure_file), touched(scratch / failure_file)};
  EXPECT_THROW(check_vacant(scratch.path()), UserError);
  start_directory(scratch.path());
  EXPECT_NO_THROW(check_vacant(scratch.path()));
  for (const fs::path& one : results) EXPECT_FALSE(fs::exists(one)) << one;
  for (const fs::path& one : others) EXPECT_TRUE(fs::exists(one)) << one;
}

TEST(Directories, ListSnapshotsInTheOrderOfTheirSteps) {
  const Scratch scratch;
  for (const char* name : {"snapshot_1000000.hdf", "snapshot_000002.hdf", "snapshot_.hdf", "snapshot_2x.hdf", "snapshot_000003.hdf.damaged"})
    touched(scratch / name);
  const std::vector<Snapshot> all = snapshots(scratch.path());
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].step, 2);
  EXPECT_EQ(all[1].step, 1000000);
  EXPECT_TRUE(snapshot_times(scratch.path()).empty());  // empty files are not readable
}

}  // namespace
}  // namespace tanktread::output
