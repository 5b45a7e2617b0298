#include "record/files/checkpoint.hpp"

#include <bit>
#include <csignal>
#include <fstream>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/errors.hpp"
#include "patches.hpp"
#include "record/files/file.hpp"
#include "record/files/snapshot.hpp"
#include "scratch.hpp"
#include "system/parallel/ranks.hpp"
#include "tests/states.hpp"

namespace tanktread::output {
namespace {

struct Scene {
  spline::Space space;
  Net net;
  std::optional<Nodes> nodes;
  Scene() {
    add_patch(space, net, 3, [](double s, double t) { return Vec3(s, t, s * t); });
    add_patch(space, net, 4, [](double s, double t) { return Vec3(1 + s, t, (1 + s) * t); });
    nodes.emplace(surface::BezierMap(space), lagrange_mesh(space, net));
  }
  std::vector<Field> fields() const {
    std::vector<Field> result = shape_fields(*nodes, net);
    result.push_back({"velocity", nodes->values(net)});
    result.push_back({"height", nodes->values(net).col(2)});
    return result;
  }
  void write(const std::filesystem::path& path, const Checkpoint& checkpoint) const {
    write_whole(path, snapshot_file(checkpoint, nodes->mesh(), fields()));
  }
};

bool same_bits(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  if (a.rows() != b.rows() || a.cols() != b.cols()) return false;
  for (Eigen::Index k = 0; k < a.size(); ++k)
    if (std::bit_cast<std::uint64_t>(a.data()[k]) != std::bit_cast<std::uint64_t>(b.data()[k])) return false;
  return true;
}

TEST(Checkpoint, IsReadBitwiseEqual) {
  using limits = std::numeric_limits<double>;
  const Scratch scratch;
  const Scene scene;
  Checkpoint checkpoint;
  checkpoint.arrays["special"] = Eigen::Matrix<double, 2, 4>{{0., -0., limits::denorm_min(), -limits::denorm_min()},
                                                             {limits::infinity(), -limits::infinity(), limits::max(), limits::min()}};
  checkpoint.arrays["random"] = Eigen::MatrixXd::Random(70, 3);
  checkpoint.arrays["empty net"] = Eigen::MatrixXd(0, 3);
  checkpoint.numbers = {{"time", 1. / 3}, {"minus zero", -0.}, {"nan", limits::quiet_NaN()}};
  checkpoint.texts = {{"deck", std::string(200000, 'x') + "\n  λ: 1\n"}, {"empty", ""}};
  scene.write(scratch / "snapshot_000001.hdf", checkpoint);

  const Checkpoint back = read_checkpoint(scratch / "snapshot_000001.hdf");
  ASSERT_EQ(back.arrays.size(), 3u);
  for (const auto& [name, matrix] : checkpoint.arrays) EXPECT_TRUE(same_bits(back.arrays.at(name), matrix)) << name;
  ASSERT_EQ(back.numbers.size(), 3u);
  for (const auto& [name, number] : checkpoint.numbers)
    EXPECT_EQ(std::bit_cast<std::uint64_t>(back.numbers.at(name)), std::bit_cast<std::uint64_t>(number)) << name;
  EXPECT_EQ(back.texts, checkpoint.texts);
}

TEST(Checkpoint, HoldsTheStateOfAnIntegrator) {
  const Scratch scratch;
  const Scene scene;
  const auto layout = std::make_shared<coupling::Layout>(
      std::vector<coupling::Block>{{"shape", 0, 12}, {"shape", 1, 8}, {"surfactant", 1, 8, 1, coupling::Parity::scalar, 0.3}});
  const auto random = [&] {
    coupling::State x(layout);
    x.numbers().setRandom();
    return x;
  };
  motion::TimeState state;
  state.time = 0.1;
  state.step = 1. / 7;
  state.x = random();
  state.history = {random(), random()};
  state.places = {{0.05, random()}, {-1. / 3, random()}};
  state.direction = random();
  state.memory = {1e-300, 2. / 3, -0.};
  state.secants.add(random(), random(), 2);
  state.frozen_time = 0.05;
  Checkpoint checkpoint;
  store(state, checkpoint);
  scene.write(scratch / "snapshot_000001.hdf", checkpoint);
  checkpoint = read_checkpoint(scratch / "snapshot_000001.hdf");
  EXPECT_EQ(checkpoint.arrays.at("x shape 2"), state.x(coupling::BlockId{1}));
  motion::TimeState back = stored_state(checkpoint);
  read_vectors(checkpoint, layout, back);
  EXPECT_EQ(back.time, state.time);
  EXPECT_EQ(back.step, state.step);
  EXPECT_TRUE(back.x == state.x);
  EXPECT_TRUE(back.history == state.history);
  ASSERT_EQ(back.places.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(back.places[k].time, state.places[k].time);
    EXPECT_TRUE(back.places[k].x == state.places[k].x);
  }
  EXPECT_TRUE(back.direction == state.direction);
  EXPECT_EQ(back.memory, state.memory);
  EXPECT_TRUE(back.secants.pairs() == state.secants.pairs());
  EXPECT_TRUE(back.frozen.empty());
  EXPECT_EQ(back.frozen_time, state.frozen_time);
  checkpoint.arrays.erase("slope_1 surfactant 2");
  EXPECT_THROW(read_vectors(checkpoint, layout, back), UserError);
  EXPECT_EQ(stored_shapes(checkpoint).rows(), 20);
  checkpoint.arrays = {{"x", Net::Ones(5, 3)}};  // as in checkpoints of earlier versions
  EXPECT_EQ(stored_shapes(checkpoint), Net::Ones(5, 3));
  EXPECT_THROW(stored_state(checkpoint), std::out_of_range);
}

TEST(TimeState, IsComparedBitwiseAcrossRanks) {
  const coupling::Ranks ranks;
  motion::TimeState state;
  state.x = state_of(Net::Ones(5, 3));
  state.places = {{0.5, state_of(Net::Ones(5, 3))}};
  EXPECT_TRUE(equal_on_all_ranks(state));
  state.places[0].x.numbers()[14] += 1e-15 * ranks.rank();
  EXPECT_EQ(equal_on_all_ranks(state), ranks.size() == 1);
}

TEST(NewestCheckpoint, PassesOverDamagedFiles) {
  const Scratch scratch;
  const Scene scene;
  EXPECT_FALSE(newest_checkpoint(scratch.path()));
  EXPECT_FALSE(newest_checkpoint(scratch / "absent"));
  for (const int step : {0, 7, 12, 1000000})
    scene.write(scratch / snapshot_name(step), {{}, {{"time", 0.5 * step}}, {}});
  EXPECT_EQ(newest_checkpoint(scratch.path())->file.step, 1000000);
  std::filesystem::resize_file(scratch / snapshot_name(1000000), 3000);
  write_whole(scratch / snapshot_name(12), "not HDF5");
  const auto newest = newest_checkpoint(scratch.path());
  EXPECT_EQ(newest->file.step, 7);
  EXPECT_EQ(newest->checkpoint.numbers.at("time"), 3.5);
  ASSERT_EQ(newest->damaged.size(), 2u);
  EXPECT_EQ(newest->damaged[0].path.filename(), snapshot_name(1000000));
  EXPECT_EQ(newest->damaged[1].path.filename(), snapshot_name(12));
  EXPECT_FALSE(newest->damaged[1].reason.empty());
}

/// /proc/self/mem is a file that can be opened, but whose first byte cannot be read (EIO).
TEST(NewestCheckpoint, IsNotSearchedForBeyondAFileThatCannotBeRead) {
  const Scratch scratch;
  const Scene scene;
  scene.write(scratch / snapshot_name(1), {{}, {{"time", 0.5}}, {}});
  const auto newer = scratch / snapshot_name(2);
  for (const char* target : {"/proc/self/mem", "/absent/file"}) {
    std::filesystem::create_symlink(target, newer);
    EXPECT_THROW(newest_checkpoint(scratch.path()), RunFailure) << target;
    std::filesystem::remove(newer);
  }
  ASSERT_EQ(mkfifo(newer.c_str(), 0600), 0);
  EXPECT_THROW(newest_checkpoint(scratch.path()), RunFailure);
}

TEST(SetAside, NeverOverwritesAnotherFile) {
  const Scratch scratch;
  for (const char* name : {"a.damaged", "a.damaged.2"}) {
    write_whole(scratch / "a", name);
    EXPECT_EQ(set_aside(scratch / "a").filename(), name);
  }
  EXPECT_EQ(contents(scratch / "a.damaged"), "a.damaged");
}

/// Changed bytes in unused parts of the file or in the snapshot's fields leave the checkpoint the same; others are detected.
TEST(Checkpoint, IsRejectedOrUnchangedIfAnyByteOfTheFileChanges) {
  const Scratch scratch;
  const Scene scene;
  Checkpoint checkpoint;
  checkpoint.arrays["x"] = Eigen::MatrixXd::Random(60, 3);
  checkpoint.numbers = {{"time", 1. / 3}};
  checkpoint.texts = {{"deck", "Tanktread:\n  Flow: {}\n"}};
  const auto path = scratch / snapshot_name(1);
  scene.write(path, checkpoint);
  const std::string whole = contents(path);
  int refused = 0;
  for (std::size_t at = 0; at < whole.size(); at += 127) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    std::ofstream(path) << damaged;
    try {
      const Checkpoint back = read_checkpoint(path);
      EXPECT_TRUE(same_bits(back.arrays.at("x"), checkpoint.arrays["x"]) && back.numbers == checkpoint.numbers && back.texts == checkpoint.texts)
          << "byte " << at;
    } catch (const std::exception&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1440 / 127) << "the array alone has 1440 bytes";
}

TEST(SnapshotSeries, OfAResumedRunContainsTheReadableSnapshotsOfTheRun) {
  const Scratch scratch;
  const Scene scene;
  SnapshotSeries series(scratch.path());
  for (const int step : {0, 4, 9}) {
    scene.write(scratch / snapshot_name(step), {{}, {{"time", 0.25 * step}}, {{"run", "this"}}});
    series.add(step, 0.25 * step);
  }
  series.write();
  const std::string whole = contents(scratch / "run.hdf.series");
  EXPECT_EQ(whole,
            "{\"file-series-version\":\"1.0\",\"files\":[\n"
            "{\"name\":\"snapshot_000000.hdf\",\"time\":0.0},\n"
            "{\"name\":\"snapshot_000004.hdf\",\"time\":1.0},\n"
            "{\"name\":\"snapshot_000009.hdf\",\"time\":2.25}\n]}\n");

  scene.write(scratch / snapshot_name(3), {{}, {{"time", 0.75}}, {{"run", "another"}}});
  SnapshotSeries resumed = SnapshotSeries::resumed(scratch.path(), 4, "this");
  EXPECT_TRUE(exists(scratch / snapshot_name(9)));
  resumed.add(9, 2.25);
  resumed.write();
  EXPECT_EQ(contents(scratch / "run.hdf.series"), whole);
}

TEST(Snapshot, KilledWhileWritingLeavesOnlyWholeFiles) {
  std::mt19937 random(2);
  for (int round = 0; round < 20; ++round) {
    const Scratch scratch;
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const pid_t child = fork();
    if (child == 0) {
      const Scene scene;
      Checkpoint checkpoint;
      checkpoint.arrays["x"] = Eigen::MatrixXd::Constant(2000, 3, 1.5);
      for (int step = 0;; ++step) {
        checkpoint.numbers["time"] = step;
        scene.write(scratch / snapshot_name(step), checkpoint);
        if (write(ends[1], &step, sizeof step) != sizeof step) _exit(1);
      }
    }
    close(ends[1]);
    int announced = 0, one;
    ASSERT_EQ(read(ends[0], &announced, sizeof announced), static_cast<ssize_t>(sizeof announced));
    usleep(std::uniform_int_distribution<useconds_t>(0, 20000)(random));
    kill(child, SIGKILL);
    while (read(ends[0], &one, sizeof one) == sizeof one) announced = one;
    close(ends[0]);
    waitpid(child, nullptr, 0);

    for (const Snapshot& snapshot : snapshots(scratch.path())) EXPECT_EQ(snapshot_label(snapshot.path)->time, snapshot.step);
    EXPECT_GE(newest_checkpoint(scratch.path())->file.step, announced);
  }
}

/// Checks the layout with another reader of HDF5.
TEST(Snapshot, HoldsTheLayoutOfVtkhdf) {
  const Scratch scratch;
  const Scene scene;
  scene.write(scratch / "snapshot_000001.hdf", {});
  const std::string script = R"(
import h5py, numpy, sys
v = h5py.File(sys.argv[1])['VTKHDF']
assert v.attrs['Version'].tolist() == [1, 0] and v.attrs['Version'].dtype == 'int64'
kind = v.attrs.get_id('Type').get_type()
assert not kind.is_variable_str() and kind.get_cset() == h5py.h5t.CSET_ASCII and v.attrs['Type'] == b'UnstructuredGrid'
for name in 'NumberOfPoints', 'NumberOfCells', 'NumberOfConnectivityIds':
    assert v[name].shape == (1,) and v[name].dtype == 'int64', name
n, cells, ids = (int(v[name][0]) for name in ('NumberOfPoints', 'NumberOfCells', 'NumberOfConnectivityIds'))
assert (n, cells, ids) == (39, 2, 41)
assert v['Connectivity'].shape == (ids,) and v['Connectivity'].dtype == 'int64' and v['Connectivity'][:].max() == n - 1
assert v['Offsets'][:].tolist() == [0, 16, 41] and v['Offsets'].dtype == 'int64'
assert v['Types'][:].tolist() == [70, 70] and v['Types'].dtype == 'uint8'
assert v['Points'].shape == (n, 3) and v['Points'].dtype == 'float64'
p = v['PointData']
assert set(p) == {'Normals', 'velocity', 'height'} and p['height'].shape == (n,) and p['velocity'].shape == (n, 3)
assert numpy.allclose(v['Points'][:, 2], p['height']) and numpy.allclose((p['Normals'][:]**2).sum(1), 1)
assert list(v['CellData']) == [] and list(v['FieldData']) == []
)";
  write_whole(scratch / "check.py", script);
  EXPECT_NO_THROW(printed_by("/usr/bin/python3 " + (scratch / "check.py").string() + " " + (scratch / "snapshot_000001.hdf").string()));
}

}  // namespace
}  // namespace tanktread::output
