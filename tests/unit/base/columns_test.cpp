#include "base/columns.hpp"

#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "base/errors.hpp"

namespace tanktread {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> names(const Columns& columns) {
  std::vector<std::string> all;
  for (const Column& one : columns.all()) all.push_back(one.name);
  return all;
}

TEST(Columns, HaveOneNameAndDescriptionPerComponent) {
  Columns row;
  row.add(0.5, {"time", "time", "simulated time"});
  row.add(Eigen::Vector3d(1, 2, 3), "x1 x2 x3", {"gap_", "length", "place, component #", "there is none"});
  EXPECT_EQ(names(row), (std::vector<std::string>{"time", "gap_x1", "gap_x2", "gap_x3"}));
  EXPECT_EQ(row.values(), (std::vector<double>{0.5, 1, 2, 3}));
  EXPECT_EQ(row.all()[2].description, "place, component x2; NaN if there is none");
  EXPECT_EQ(row.value("gap_x3"), 3);
  EXPECT_THROW(row.value("gap"), std::out_of_range);
}

TEST(Columns, ThatAreNotANumberEndTheRunUnlessTheyMayBeUndefined) {
  Columns row;
  row.add(nan, {"inclination", "degree", "angle", "no axis is longest"});
  EXPECT_NO_THROW(row.check());
  row.add(nan, {"drag_error", "1", "error"});
  try {
    row.check();
    FAIL();
  } catch (const RunFailure& failure) {
    EXPECT_NE(std::string(failure.what()).find("drag_error"), std::string::npos);
  }
}

TEST(Columns, OfParticlesFollowEachOtherAndAreFoundByName) {
  Columns row, one, other;
  row.add(7, {"area", "length^2", "of all"});
  EXPECT_EQ(row.of_particles("area"), std::vector<double>{7});
  one.add(3, {"area", "length^2", "of one"});
  other.add(4, {"area", "length^2", "of one"});
  row.append(one, "a/"), row.append(other, "b/");
  EXPECT_EQ(names(row), (std::vector<std::string>{"area", "a/area", "b/area"}));
  EXPECT_EQ(row.of_particles("area"), (std::vector<double>{3, 4}));
  EXPECT_TRUE(row.of_particles("volume").empty());
}

TEST(Columns, AreSortedByRankAndThenAsAdded) {
  Columns row;
  for (const char* name : {"c", "b2", "b1", "a"}) row.add(name[0], {name, "1", ""});
  row.sort([](const std::string& name) { return static_cast<std::size_t>(name[0]); });
  EXPECT_EQ(names(row), (std::vector<std::string>{"a", "b2", "b1", "c"}));
  EXPECT_EQ(row.values(), (std::vector<double>{'a', 'b', 'b', 'c'}));
}

TEST(Columns, OfAManualAreThoseOfEveryDeck) {
  EXPECT_TRUE(Columns(true).when(false));
  EXPECT_FALSE(Columns().when(false));
}

}  // namespace
}  // namespace tanktread
