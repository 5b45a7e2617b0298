#include "record/files/summary.hpp"

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include "deck/words.hpp"
#include "record/files/file.hpp"
#include "record/files/progress.hpp"
#include "scratch.hpp"

namespace tanktread::output {
namespace {

TEST(Numbers, ReadBackAsTheSameDouble) {
  std::mt19937_64 random(3);
  for (int k = 0; k < 1000; ++k) {
    const double value = std::ldexp(std::uniform_real_distribution<>(-1, 1)(random), std::uniform_int_distribution<>(-1000, 1000)(random));
    EXPECT_EQ(std::stod(deck::real_text(value)), value);
  }
}

TEST(Numbers, AlwaysShowAPoint) {
  EXPECT_EQ(deck::real_text(1), "1.0");
  EXPECT_EQ(deck::real_text(1e-6), "1.0e-06");
  EXPECT_EQ(deck::real_text(-0.), "-0.0");
  EXPECT_EQ(deck::real_text(1e22), "1.0e+22");
}

TEST(Durations, HaveReadableUnits) {
  EXPECT_EQ(duration(0.84), "0.8 s");
  EXPECT_EQ(duration(59.4), "59 s");
  EXPECT_EQ(duration(59.6), "1 min 00 s");
  EXPECT_EQ(duration(7500), "2 h 05 min");
}

TEST(Summary, IsReadByPythonAsItWasMeant) {
  const Scratch scratch;
  Summary summary;
  summary.final = {{"time", 7.5}, {"volume_error", 1e-15}, {"energy", std::nan("")}, {"drag", -std::numeric_limits<double>::infinity()}};
  summary.expect = {{"taylor_inertia", 0.39785, 0.3979, -5e-5, true}, {"no", 1, 2, -1, false}};
  summary.counts = {{"steps", 42}, {"velocity evaluations", 1234567890123}, {"on", 1}, {"1e3", 2}};
  summary.seconds = {{"far field: near: self", 1.25}};
  summary.memory = {{"all ranks", 3'000'000'000}};
  summary.final_in_si = {{"time", "0.0075 s"}};
  summary.final_vectors = {{"torque", Vec3(1, -2, 0.5)}};
  summary.errors = {{"mesh", "unknown"}};
  summary.modes = {{"1", "shape"}};
  summary.obstacles = {"the mesh is too coarse"};
  summary.plan = {{"flow", "simple shear, γ̇ = 1: \"λ = 1\" # no double layer\n\tC:\\"}, {"yes", ""}};
  summary.warnings = {"the load: \"strong\" # it fails"};
  write_whole(scratch / "summary.yaml", yaml(summary));
  write_whole(scratch / "check.py", R"(
import math, sys, yaml
s = yaml.safe_load(open(sys.argv[1], encoding='utf-8'))
assert list(s) == ['status', 'final', 'final in SI', 'expect', 'counts', 'seconds', 'memory', 'plan', 'numbers', 'estimated errors', 'modes',
                   'warnings', 'obstacles']
assert s['final in SI'] == {'time': '0.0075 s'} and s['final']['torque'] == [1.0, -2.0, 0.5] and s['estimated errors'] == {'mesh': 'unknown'}
assert s['modes'] == {'1': 'shape'} and s['obstacles'] == ['the mesh is too coarse']
f = s['final']
assert f['time'] == 7.5 and f['volume_error'] == 1e-15 and math.isnan(f['energy']) and f['drag'] == -math.inf
assert s['expect'] == [dict(name='taylor_inertia', value=0.39785, expected=0.3979, error=-5e-5, passed=True),
                       dict(name='no', value=1.0, expected=2.0, error=-1.0, passed=False)]
assert s['counts'] == {'steps': 42, 'velocity evaluations': 1234567890123, 'on': 1, '1e3': 2}
assert s['seconds'] == {'far field: near: self': 1.25}
assert s['memory'] == {'all ranks': 3000000000}
assert s['plan'] == {'flow': 'simple shear, γ̇ = 1: "λ = 1" # no double layer\n\tC:\\', 'yes': ''}, s['plan']
assert s['warnings'] == ['the load: "strong" # it fails']
)");
  EXPECT_NO_THROW(printed_by("/usr/bin/python3 " + (scratch / "check.py").string() + " " + (scratch / "summary.yaml").string()));
}

TEST(Summary, StatesHowTheRunEnded) {
  for (const char* status : {run_status::done, run_status::steady, run_status::past}) {
    EXPECT_TRUE(reached_end(status)) << status;
    EXPECT_EQ(status_of(yaml(Summary{.status = status})), status);
  }
  for (const std::string status : {run_status::by_signal, run_status::by_clock, run_status::failed, ""}) EXPECT_FALSE(reached_end(status)) << status;
  EXPECT_EQ(status_of(""), "");
}

TEST(Summary, IsChangedEntryByEntry) {
  const std::string summary = "status: \"done\"\nexpect: []\nestimated errors:\n  mesh: \"unknown\"\n  time: \"1\"\nwarnings:\n  - \"a\"\n";
  EXPECT_EQ(with_entry(summary, "status", yaml_status(run_status::by_clock)),
            "status: \"stopped: at the wall-clock limit\"\n" + summary.substr(summary.find("expect")));
  EXPECT_EQ(with_entry(summary, "estimated errors", ""), "status: \"done\"\nexpect: []\nwarnings:\n  - \"a\"\n");
  EXPECT_EQ(with_entry(summary, "warnings", "warnings: []\n"),
            "status: \"done\"\nexpect: []\nestimated errors:\n  mesh: \"unknown\"\n  time: \"1\"\nwarnings: []\n");
  EXPECT_EQ(with_entry(summary, "time", "time: 1\n"), summary + "time: 1\n");  // a key of a map is no entry
  EXPECT_EQ(with_entry("", "expect", "expect: []\n"), "expect: []\n");
}

TEST(Summary, WithoutContentIsAMapOfItsParts) {
  EXPECT_EQ(yaml(Summary{}), "status: \"done\"\nfinal: {}\nexpect: []\ncounts: {}\nseconds: {}\nplan: {}\nnumbers: {}\nwarnings: []\n");
}

}  // namespace
}  // namespace tanktread::output
