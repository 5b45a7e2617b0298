#include "deck/expectation.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "options.hpp"

namespace tanktread::deck {
namespace {

std::vector<Expectation> expectations(const std::string& lines) {
  Sample sample;
  Document document = read_text("Tanktread:\n  Expect:\n" + lines);
  document.declare(sample);
  return sample.expect.all;
}

const SeriesTable cubic = [] {
  SeriesTable table;
  for (const double t : {0.0, 0.1, 0.4, 0.5, 0.9, 1.5, 2.0}) {
    table["time"].push_back(t);
    table["volume"].push_back(1 + t - t * t + 0.5 * t * t * t);
  }
  return table;
}();

TEST(Expectations, AreReadByName) {
  const auto all = expectations(
      "    volume: {value: 4.19, tolerance: 1e-3, kind: relative, at: 7.5, source: \"sphere, exact\"}\n    energy: {value: 1, tolerance: "
      "0.1}\n");
  ASSERT_EQ(all.size(), 2u);
  EXPECT_EQ(all[0].name, "volume");
  EXPECT_EQ(all[0].series, "volume");
  EXPECT_EQ(all[0].value, 4.19);
  EXPECT_EQ(all[0].kind, "relative");
  EXPECT_EQ(all[0].at, 7.5);
  EXPECT_FALSE(all[1].at.has_value());
}

TEST(Expectations, NeedValueAndTolerance) {
  EXPECT_EQ(refusal_of("Tanktread:\n  Expect:\n    volume: {value: 1}\n"),
            "Expect/volume/tolerance is missing; an expectation needs `value` and `tolerance`.");
  EXPECT_EQ(refusal_of("Tanktread:\n  Expect:\n    volume: 1\n"), "Expect/volume must be a section of keys, but is 1.");
  EXPECT_EQ(refusal_of("Tanktread:\n  Expect:\n    volume: {value: 1, tolerance: 1, tol: 2}\n"),
            "Expect/volume/tol is not a key of the deck; was Expect/volume/tolerance meant?");
  EXPECT_EQ(refusal_of("Tanktread:\n  Expect:\n    volume: {value: 0, tolerance: 1, kind: relative}\n"),
            "Expect/volume/kind `relative` and the value 0 contradict each other: an error cannot be divided by 0. Give `absolute`.");
}

TEST(Expectations, NameExistingSeries) {
  const auto refusal = [](const std::string& line, const std::vector<std::string>& names) -> std::string {
    try {
      check_series(expectations(line), names);
    } catch (const UserError& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_EQ(refusal("    volume: {value: 1, tolerance: 1}\n", {"time", "volume"}), "none");
  EXPECT_EQ(refusal("    half: {series: volume, value: 1, tolerance: 1}\n", {"time", "volume"}), "none");
  EXPECT_EQ(refusal("    volum: {value: 1, tolerance: 1}\n", {"time", "volume"}),
            "Expect/volum: the results of this scene hold no series volum; was volume meant?");
  EXPECT_EQ(refusal("    volume: {series: wellness, value: 1, tolerance: 1}\n", {"time", "volume", "area"}),
            "Expect/volume/series: the results of this scene hold no series wellness, but time, volume or area.");
  EXPECT_EQ(refusal("    wellness: {value: 1, tolerance: 1, not binding: a key was changed}\n", {"time", "volume"}), "none");
}

TEST(Expectations, AfterTheEndAreReportedAsMissed) {
  const auto late = [](double end) {
    return too_late(expectations("    volume: {value: 1, tolerance: 1, at: 0.3}\n    area: {value: 1, tolerance: 1}\n"), end);
  };
  EXPECT_TRUE(late(0.3).empty());
  EXPECT_TRUE(late(0.1 + 0.2).empty());
  EXPECT_EQ(too_late(expectations("    volume: {value: 1, tolerance: 1, at: 2.0e-10}\n"), 1e-10).size(), 1u) << "a small unit of time";
  EXPECT_EQ(late(0.25), std::vector<std::string>{"Expect/volume will be missed: it is for the time 0.3, and the run ends at 0.25"});
}

TEST(Interpolation, IsExactForCubicsAndAtTheRows) {
  for (const double t : {0.0, 0.05, 0.1, 0.3, 0.45, 0.7, 1.0, 1.7, 2.0})
    EXPECT_NEAR(interpolated(cubic.at("time"), cubic.at("volume"), t), 1 + t - t * t + 0.5 * t * t * t, 1e-14) << t;  // round-off
  EXPECT_EQ(interpolated({0.0, 1.0}, {2.0, 4.0}, 0.5), 3.0) << "two rows: a line";
  EXPECT_EQ(interpolated({1.0}, {2.0}, 1.0), 2.0);
}

TEST(Verdicts, ReferToTheLastRowOrToATime) {
  const auto all = verdicts(
      expectations(
          "    last: {series: volume, value: 3, tolerance: 1e-9}\n    half: {series: volume, value: 1.3, tolerance: 0.02, at: 0.5}\n"
          "    off: {series: volume, value: 3.3, tolerance: 0.05, kind: relative}\n"),
      cubic);
  ASSERT_EQ(all.size(), 3u);
  EXPECT_TRUE(all[0].passed);
  EXPECT_EQ(all[0].value, 3.0);
  EXPECT_TRUE(all[1].passed);
  EXPECT_NEAR(all[1].error, 0.0125, 1e-14);
  EXPECT_FALSE(all[2].passed);
  EXPECT_NEAR(all[2].error, 0.3 / 3.3, 1e-14);
  EXPECT_EQ(all[2].reason, "volume is 3, expected 3.3 within 0.05 (relative)");
}

TEST(Verdicts, AreNeverFewerThanDeclared) {
  const auto all = verdicts(
      expectations("    nothing: {value: 1, tolerance: 1}\n    late: {series: volume, value: 1, tolerance: 100, at: 2.1}\n"), cubic);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_FALSE(all[0].passed);
  EXPECT_EQ(all[0].reason, "the results hold no series nothing");
  EXPECT_FALSE(all[1].passed);
  EXPECT_EQ(all[1].reason, "the results do not reach the time 2.1");
}

TEST(Interpolation, LeavesOutUndefinedValues) {
  const double nan = std::nan("");
  const std::vector<double> times = {0, 1, 2, 3, 4, 5, 6}, values = {nan, 1, 8, 27, nan, 125, 216};  // t^3
  EXPECT_TRUE(std::isnan(interpolated(times, values, 0)));
  EXPECT_TRUE(std::isnan(interpolated(times, values, 0.5))) << "next to an undefined row";
  EXPECT_TRUE(std::isnan(interpolated(times, values, 3.5)));
  EXPECT_EQ(interpolated(times, values, 3), 27);
  EXPECT_NEAR(interpolated(times, values, 1.5), (3 * 1 + 6 * 8 - 27) / 8., 1e-14) << "a parabola through three rows";
  EXPECT_NEAR(interpolated(times, values, 5.5), (125 + 216) / 2., 1e-13) << "a line through two";
}

TEST(Verdicts, StateWhereASeriesIsUndefined) {
  const SeriesTable table = {{"time", {0, 1, 2}}, {"angle", {std::nan(""), 10, 20}}, {"gap", {1, 1, std::nan("")}}};
  const auto all = verdicts(
      expectations("    early: {series: angle, value: 1, tolerance: 1e70, at: 0.5}\n    late: {series: angle, value: 20, tolerance: 1}\n"
                   "    last: {series: gap, value: 1, tolerance: 1}\n"),
      table, {{"angle", "two axes are equal"}, {"gap", "two bodies are none"}});
  ASSERT_EQ(all.size(), 3u);
  EXPECT_FALSE(all[0].passed);
  EXPECT_TRUE(std::isnan(all[0].value));
  EXPECT_EQ(all[0].reason, "angle is undefined at the time 0.5, because two axes are equal");
  EXPECT_TRUE(all[1].passed);
  EXPECT_EQ(all[1].reason, "");
  EXPECT_EQ(all[2].reason, "gap is undefined at the end, because two bodies are none");
}

TEST(Verdicts, OfAnInclinationHaveThePeriodOfAnAxis) {
  SeriesTable table;
  for (int k = 0; k <= 20; ++k) table["time"].push_back(k), table["inclination"].push_back(std::remainder(80.5 + k, 180));
  for (const auto& [at, value] : {std::pair("9.5", "90"), {"9.5", "-90"}, {"9.25", "89.75"}, {"20", "-79.5"}}) {
    const auto found = verdicts(expectations(std::string("    inclination: {value: ") + value + ", tolerance: 1e-9, at: " + at + "}\n"), table);
    EXPECT_TRUE(found[0].passed) << at << ": " << found[0].value;
  }
}

TEST(Verdicts, FailForNan) {
  EXPECT_FALSE(verdicts(expectations("    a: {value: 1, tolerance: 1e70}\n"), {{"time", {0.0}}, {"a", {std::nan("")}}})[0].passed);
}

}  // namespace
}  // namespace tanktread::deck
