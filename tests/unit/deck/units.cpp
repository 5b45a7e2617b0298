#include "deck/units.hpp"

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "base/errors.hpp"

namespace tanktread::deck {
namespace {

TEST(Units, TakeNumbersOfEveryKind) {
  const Units units({"2 um", "5 ms", "3 pN"});
  EXPECT_DOUBLE_EQ(units.number("1 mm", "length"), 500);
  EXPECT_DOUBLE_EQ(units.number("-100 1/s", "1/time"), -0.5);
  EXPECT_DOUBLE_EQ(units.number("5.3uN/m", "force/length"), 5.3e-6 / (3e-12 / 2e-6));
  EXPECT_DOUBLE_EQ(units.number("35 mPa s", "stress x time"), 35e-3 / (3e-12 / 4e-12 * 5e-3));
  EXPECT_DOUBLE_EQ(units.number("0.32 µN.s/m", "viscosity x length"), 0.32e-6 / (3e-12 / 2e-6 * 5e-3));
  EXPECT_DOUBLE_EQ(units.number("2e-19 J", "force x length"), 2e-19 / 6e-18);
  EXPECT_NEAR(units.number("50 kg/m^3", "force/(length^3 x Flow/gravity)"), 50 / (3e-12 / 8e-18 / (2e-6 / 25e-6)), 1e-9);
  EXPECT_DOUBLE_EQ(units.number("2 h", "seconds"), 7200);
}

/// Each line of spellings.txt is accepted with the right value, or refused with a message that contains the words.
TEST(Units, TakeWhatPeopleWrite) {
  const Units si({"1 m", "1 s", "1 N"});
  std::ifstream file(std::filesystem::path(__FILE__).replace_filename("spellings.txt"));
  int count = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with('#')) continue;
    std::vector<std::string> cells;
    for (std::size_t at = 0, end = 0; end != line.npos; at = end + 2) end = line.find("; ", at), cells.push_back(line.substr(at, end - at));
    ASSERT_GE(cells.size(), 3u) << line;
    char* rest = nullptr;
    const double value = std::strtod(cells[2].c_str(), &rest);
    ++count;
    try {
      const double read = si.number(cells[1], cells[0]);
      EXPECT_TRUE(*rest == 0 && std::abs(read - value) <= 1e-12 * std::abs(value)) << line << " is read as " << read;
    } catch (const std::invalid_argument& error) {
      for (std::size_t k = 2; k < cells.size(); ++k)
        EXPECT_NE(std::string(error.what()).find(cells[k]), std::string::npos) << line << ": " << error.what();
    }
  }
  EXPECT_GE(count, 100);
}

TEST(Units, FindValuesAThousandTimesTooLargeOrTooSmall) {
  const Units units({});
  EXPECT_EQ(units.unusual("stress x time", 22), "is 22 Pa s, but values of 1e-06 to 1 Pa s are usual: check its unit");
  EXPECT_EQ(units.unusual("length", 4e-6), "is 4e-12 m, but values of 5e-09 to 0.01 m are usual: check its unit");
  EXPECT_EQ(units.unusual("length", 4e-6, true), "");
  EXPECT_NE(units.unusual("force x length", 2e-19), "") << "a number in J beside plain numbers in pN um";
  EXPECT_NE(units.unusual("length/time^2", 9.81), "") << "a number in m/s^2 beside plain numbers in um/s^2";
  for (const auto& [kind, number] : {std::pair("stress x time", 1.0), {"length", 3.91}, {"force/length", 5.3}, {"force x length", 0.2}, {"1", 1e9},
                                     {"degree", 1e9}, {"length/time^2", 9.81e6}, {"time", 0.0}, {"R_C", 1e9}})
    EXPECT_EQ(units.unusual(kind, number), "") << kind;
}

TEST(Units, AreStatedInSI) {
  const Units units({"2 um", "5 ms", "3 pN"});
  EXPECT_EQ(units.in_si("length/time"), "0.0004 m/s");
  EXPECT_EQ(units.in_si("force length", 10), "6e-17 N m");
  EXPECT_EQ(units.in_si("1"), "");
  EXPECT_EQ(units.in_si("degree"), "");
}

TEST(Units, RejectOtherDimensions) {
  const Units units({});
  for (const char* kind : {"length", "1/time", "1", "R_C", "that of the key"})
    EXPECT_THROW(units.number("1 uN", kind), std::invalid_argument) << kind;
  EXPECT_THROW(units.number("1 frog", "length"), std::invalid_argument);
  EXPECT_THROW(units.number("um", "length"), std::invalid_argument);
  EXPECT_THROW(Units({"1 s", "1 s", "1 N"}), UserError);
  EXPECT_THROW(Units({"1 um", "1 s", "3"}), UserError);
}

}  // namespace
}  // namespace tanktread::deck
