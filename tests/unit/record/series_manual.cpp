#include "record/series_manual.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "accuracy/request.hpp"
#include "record/duct_arrays.hpp"
#include "scene/series/series.hpp"

namespace tanktread {
namespace {

TEST(SeriesManual, ListsEverySeriesWithoutAnError) {
  const std::vector<Column> all = columns_of_all_runs().all();
  for (const std::string_view name : accuracy::series_without_error())
    EXPECT_TRUE(std::ranges::find(all, name, &Column::name) != all.end()) << "without_error in accuracy/request.cpp: " << name;
}

/// Returns whether put_in_order() knows the place of a column: it then comes before a column without a place that was added earlier.
bool has_place(const std::string& name) {
  Columns two;
  two.add(0, {"no column has this name", "1", ""});
  two.add(0, {name, "1", ""});
  put_in_order(two);
  return two.all().front().name == name;
}

TEST(SeriesManual, ListsOnlySeriesWithAPlaceInTheOrder) {
  EXPECT_FALSE(has_place("another"));
  for (const Column& one : columns_of_all_runs().all()) EXPECT_TRUE(has_place(one.name)) << "`order` in scene/series/series.cpp: " << one.name;
  EXPECT_TRUE(has_place("post/post_force_x1"));  // a post with a name
  for (const char* one : {"torque_applied", "torque_error_x", "angular_velocity"}) EXPECT_FALSE(has_place(one)) << one;  // not components
}

TEST(SeriesManual, DescribesTheArraysOfChannels) {
  const std::string manual = series_manual(Registry());
  for (const output::Array& one : described_channel_arrays()) {
    EXPECT_TRUE(one.values.empty()) << one.name;
    EXPECT_NE(manual.find("| `" + one.name + "` | " + one.unit + " | " + one.description + " |\n"), manual.npos) << one.name;
  }
}

}  // namespace
}  // namespace tanktread
