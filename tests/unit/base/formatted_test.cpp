#include "base/formatted.hpp"

#include <gtest/gtest.h>

namespace tanktread {
namespace {

TEST(Formatted, TextsHaveNoLengthLimit) {
  const std::string longer(5000, 'x');
  EXPECT_EQ(formatted("%s!", longer.c_str()), longer + "!");
  EXPECT_EQ(formatted("%d of %.3g", 3, 0.25), "3 of 0.25");
  EXPECT_EQ(formatted("%s", ""), "");
}

}  // namespace
}  // namespace tanktread
