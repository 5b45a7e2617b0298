#include "deck/units.hpp"

#include <stdexcept>

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
