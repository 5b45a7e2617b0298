#include "record/files/run_record.hpp"

#include <cmath>
#include <csignal>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/errors.hpp"
#include "record/files/file.hpp"
#include "scratch.hpp"

namespace tanktread::output {
namespace {

const std::string deck = "Tanktread:\n  Flow:\n    type: simple shear # γ̇ = 1\n";

RunRecord three_series(const std::filesystem::path& path) {
  RunRecord record(path, deck, {{"version", "0.1"}, {"ranks", "2"}});
  record.declare("time", "1/shear rate", "simulated time");
  record.declare("taylor_inertia", "1", "Taylor parameter of the ellipsoid of inertia");
  record.declare("area", "length^2", "area of the membrane");
  return record;
}

TEST(RunRecord, IsReadAsItWasWritten) {
  const Scratch scratch;
  RunRecord record = three_series(scratch / "run.h5");
  record.append(std::array{0.0, -0.0, std::numeric_limits<double>::denorm_min()});
  record.append(std::array{0.1, 1.0 / 3.0, std::numeric_limits<double>::quiet_NaN()});
  record.write(Durable::yes);

  const RunRecord back = RunRecord::load(scratch / "run.h5");
  EXPECT_EQ(back.rows(), 2u);
  EXPECT_EQ(back.deck(), deck);
  EXPECT_EQ(back.provenance(), record.provenance());
  EXPECT_EQ(back.values("taylor_inertia")[1], 1.0 / 3.0);
  EXPECT_TRUE(std::signbit(back.values("taylor_inertia")[0]));
  EXPECT_EQ(back.values("area")[0], std::numeric_limits<double>::denorm_min());
  EXPECT_TRUE(std::isnan(back.values("area")[1]));
  for (const Series& series : back.series())
    if (series.name == "area") {
      EXPECT_EQ(series.unit, "length^2");
      EXPECT_EQ(series.description, "area of the membrane");
    }
}

TEST(RunRecord, ContinuesFromAnEarlierRow) {
  const Scratch scratch;
  RunRecord whole = three_series(scratch / "whole.h5"), first = three_series(scratch / "run.h5");
  for (int k = 0; k < 6; ++k) whole.append(std::array{0.1 * k, 1. * k, std::sin(k)});
  for (int k = 0; k < 5; ++k) first.append(std::array{0.1 * k, 1. * k, k < 3 ? std::sin(k) : -1});
  first.write();

  RunRecord resumed = RunRecord::load(scratch / "run.h5");
  resumed.truncate(3);
  resumed.declare("time", "1/shear rate", "simulated time");
  resumed.declare("taylor_inertia", "1", "Taylor parameter of the ellipsoid of inertia");
  resumed.declare("area", "length^2", "area of the membrane");
  for (int k = 3; k < 6; ++k) resumed.append(std::array{0.1 * k, 1. * k, std::sin(k)});
  resumed.write();

  const RunRecord back = RunRecord::load(scratch / "run.h5");
  for (const Series& series : whole.series()) EXPECT_EQ(back.values(series.name), series.values) << series.name;
}

TEST(RunRecord, ASeriesThatIsNewOnResumeHasNoValuesBefore) {
  const Scratch scratch;
  RunRecord record(scratch / "run.h5", "", {});
  record.declare("time", "1", "");
  record.append(std::array{0.5});
  record.declare("energy", "1", "");
  record.append(std::array{1.5, 2.5});
  record.write();
  const RunRecord back = RunRecord::load(scratch / "run.h5");
  EXPECT_TRUE(std::isnan(back.values("energy")[0]));
  EXPECT_EQ(back.values("energy")[1], 2.5);
}

TEST(RunRecord, ASeriesThatIsNewOnResumeKeepsTheChecksumOfEarlierRows) {
  RunRecord record("run.h5", "", {});
  record.declare("time", "1", "");
  record.append(std::array{0.5});
  const std::string before = record.checksum(1);
  record.declare("energy", "1", "");
  EXPECT_EQ(record.checksum(1), before);
  EXPECT_NE(record.checksum(1, true), before);
  record.append(std::array{1.5, 2.5});
  EXPECT_EQ(record.checksum(1), before);
  EXPECT_NE(record.checksum(2), before);
}

TEST(RunRecord, ItsChecksumIsOfItsFirstRowsInAnyOrderOfTheSeries) {
  const Scratch scratch;
  RunRecord record = three_series(scratch / "run.h5");
  for (int k = 0; k < 4; ++k) record.append(std::array{0.1 * k, -1. * k, std::sin(k)});
  record.write();
  RunRecord back = RunRecord::load(scratch / "run.h5");  // its series are in alphabetical order
  const std::string of_three = back.checksum(3);
  EXPECT_EQ(of_three, record.checksum(3));
  EXPECT_NE(of_three, record.checksum(4));
  record.append(std::array{0., 0., 0.});
  EXPECT_EQ(of_three, record.checksum(3));
  RunRecord other = three_series(scratch / "other.h5");
  for (int k = 0; k < 3; ++k) other.append(std::array{0.1 * k, -1. * k, k == 1 ? std::nextafter(std::sin(k), 1) : std::sin(k)});
  EXPECT_NE(of_three, other.checksum(3));
}

TEST(RunRecord, RejectsARowOfTheWrongLength) {
  const Scratch scratch;
  RunRecord record = three_series(scratch / "run.h5");
  EXPECT_THROW(record.append(std::array{1.0}), std::logic_error);
}

TEST(RunRecord, ReportsADamagedFile) {
  const Scratch scratch;
  three_series(scratch / "run.h5").write();
  std::filesystem::resize_file(scratch / "run.h5", 1000);
  EXPECT_THROW(RunRecord::load(scratch / "run.h5"), UserError);
  EXPECT_THROW(RunRecord::load(scratch / "absent.h5"), UserError);
}

TEST(RunRecord, AWriteErrorIsARunFailure) { EXPECT_THROW(three_series("/proc/none/run.h5").write(), RunFailure); }

/// Writes rows (k, k^2, 1/k) without end, and sends through the pipe the number of the latest row written.
[[noreturn]] void append_until_killed(const std::filesystem::path& path, int pipe) {
  RunRecord record = three_series(path);
  for (std::uint32_t k = 0;; ++k) {
    record.append(std::array{double(k), double(k) * k, 1 / double(k)});
    record.write();
    if (write(pipe, &k, sizeof k) != sizeof k) _exit(1);
  }
}

TEST(RunRecord, KilledAtAnyMomentHoldsEveryRowThatWasAnnounced) {
  std::mt19937 random(1);
  for (int round = 0; round < 20; ++round) {
    const Scratch scratch;
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) append_until_killed(scratch / "run.h5", ends[1]);
    close(ends[1]);

    std::uint32_t announced = 0, one;
    ASSERT_EQ(read(ends[0], &announced, sizeof announced), static_cast<ssize_t>(sizeof announced));
    usleep(std::uniform_int_distribution<useconds_t>(0, 50000)(random));
    kill(child, SIGKILL);
    while (read(ends[0], &one, sizeof one) == sizeof one) announced = one;
    close(ends[0]);
    waitpid(child, nullptr, 0);

    const RunRecord back = RunRecord::load(scratch / "run.h5");
    ASSERT_GT(back.rows(), announced);
    for (std::size_t k = 0; k < back.rows(); ++k) EXPECT_EQ(back.values("taylor_inertia")[k], double(k) * double(k));
  }
}

TEST(OutputDirectory, IsClearedOfOldResultsAndKeepsOtherFiles) {
  const Scratch scratch;
  for (const char* name : {"run.h5", "snapshot_000003.hdf", "snapshot_000004.hdf.part", "snapshot_000005.hdf.damaged.2", "summary.yaml",
                           "notes.txt", "picture.png.part"})
    write_whole(scratch / name, "old");
  tidy_directory(scratch.path());
  EXPECT_FALSE(exists(scratch / "snapshot_000004.hdf.part"));
  EXPECT_TRUE(exists(scratch / "run.h5"));
  EXPECT_THROW(check_vacant(scratch.path()), UserError);
  start_directory(scratch.path());
  EXPECT_NO_THROW(check_vacant(scratch.path()));
  EXPECT_NO_THROW(check_vacant(scratch / "absent"));
  EXPECT_FALSE(exists(scratch / "run.h5") || exists(scratch / "snapshot_000003.hdf") || exists(scratch / "summary.yaml") ||
               exists(scratch / "snapshot_000005.hdf.damaged.2"));
  EXPECT_TRUE(exists(scratch / "notes.txt") && exists(scratch / "picture.png.part"));
  start_directory(scratch / "new");
  EXPECT_TRUE(exists(scratch / "new"));
  EXPECT_THROW(start_directory(scratch / "notes.txt"), UserError);
}

}  // namespace
}  // namespace tanktread::output
