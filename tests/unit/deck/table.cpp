#include "deck/table.hpp"

#include <filesystem>
#include <fstream>

#include <unistd.h>

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include "base/errors.hpp"
#include "deck/units.hpp"

namespace tanktread::deck {
namespace {

using Rows = std::vector<std::vector<double>>;

/// A file that exists as long as the test.
class Tables : public testing::Test {
 protected:
  ~Tables() override { std::filesystem::remove(path_); }

  /// Returns the numbers of a table, or the sentence with which it is refused.
  std::pair<Rows, std::string> read(const std::string& text, const TableForm& form, const UnitOptions* units = nullptr) {
    std::ofstream(path_, std::ios::binary) << text;
    Rows rows;
    try {
      for (const TableRow& row : read_table({path_, units ? std::make_shared<Units>(*units) : nullptr}, "The table", form)) {
        rows.push_back(row.numbers);
        marks_ += row.marked;
      }
    } catch (const UserError& error) {
      return {{}, error.what()};
    }
    return {rows, ""};
  }

  int marks_ = 0;

 private:
  std::string path_ = testing::TempDir() + "table_" + std::to_string(getpid()) + ".csv";
};

/// Returns the bytes of a text with one character per byte.
std::string bytes(const std::string& text) {
  std::string found;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const auto c = static_cast<unsigned char>(text[k]);
    found += static_cast<char>(c < 0x80 ? c : (c & 3) << 6 | (static_cast<unsigned char>(text[++k]) & 0x3F));
  }
  return found;
}

TEST_F(Tables, OfOtherProgramsAreReadOrRefusedInOneSentence) {
  const UnitOptions deck_units{"1 um", "1 ms", "1 pN"};
  int count = 0;
  for (const auto& one : YAML::LoadFile(SOURCE_DIRECTORY "/tests/unit/deck/tables.yaml")) {
    const YAML::Node table = one.second;
    if (table["package only"]) continue;
    SCOPED_TRACE(one.first.as<std::string>());
    TableForm form{{}, {2, 3}};
    const auto wanted = table["as"] ? table["as"].as<std::vector<std::string>>() : std::vector<std::string>{"time", "value", "error"};
    for (const std::string& name : wanted) form.columns.push_back({name, "1", name == "value"});
    if (table["as"]) form.counts = {wanted.size()};
    if (table["counts"]) form.counts = table["counts"].as<std::vector<std::size_t>>();
    if (const YAML::Node units = table["units"])
      for (std::size_t k = 0; k < units.size(); ++k) form.columns[k].unit = bytes(units[k].as<std::string>());  // so that the numbers stay
    const auto [rows, message] = read(bytes(table["text"].as<std::string>()), form, &deck_units);
    EXPECT_EQ(rows, table["values"] ? table["values"].as<Rows>() : Rows());
    EXPECT_TRUE(message.find(table["says"] ? table["says"].as<std::string>() : "") != std::string::npos) << message;
    EXPECT_EQ(message.empty(), !table["says"]) << message;
    ++count;
  }
  EXPECT_GT(count, 40);
}

TEST_F(Tables, WithUnitsAreInTheUnitsOfTheDeck) {
  const UnitOptions units{"1 um", "1 ms", "1 pN"};
  const TableForm form{{{"time", "time"}, {"x1", "length"}, {"angle", "degree"}}, {3}};
  EXPECT_EQ(read("angle (deg);x (mm);time (s)\n90;0,5;2\n", form, &units).first, (Rows{{2000, 500, 90}}));
  EXPECT_EQ(read("time,x1,angle\n1,2.5,3\n", form, &units).first, (Rows{{1, 2.5, 3}}));
  EXPECT_EQ(read("time (s),x1,angle\n1,2.5,3\n", form).second,
            "The table, line 1, columns separated by commas: the column time has the unit s, but the deck has no section Units: add it, or "
            "remove the "
            "unit from this line; expected are 3 columns of numbers, time, x1, angle.");
  EXPECT_NE(read("time (um),x1,angle\n1,2.5,3\n", form, &units).second.find("has the unit um, but this is not a known unit of time"),
            std::string::npos);
}

TEST_F(Tables, MayHaveAWordAtTheEndOfARow) {
  const TableForm form{{{"x2", "length"}, {"x3", "length"}}, {2}, "corner"};
  EXPECT_EQ(read("x2,x3,corner\n0,1,corner\n0.5,1,\n1,0\n", form).first, (Rows{{0, 1}, {0.5, 1}, {1, 0}}));
  EXPECT_EQ(marks_, 1);
  EXPECT_NE(read("0,1,edge\n", form)
                .second.find("\"edge\" is not a number; expected are 2 columns of numbers, x2, x3, and where it applies the word "
                             "`corner`."),
            std::string::npos);
}

}  // namespace
}  // namespace tanktread::deck
