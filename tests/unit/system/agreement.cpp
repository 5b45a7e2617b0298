// What ranks agree on.

#include "system/agreement.hpp"

#include <vector>

#include <gtest/gtest.h>

#include "system/ranks.hpp"

namespace tanktread::coupling {
namespace {

TEST(Agreement, TheWorstOutcomeAndTheFirstRanksNumbersAreEverybodys) {
  const Ranks ranks;
  EXPECT_EQ(largest(ranks.rank() + 1, "said by none, for all come"), ranks.size());
  EXPECT_EQ(largest(0), 0);
  std::vector<double> numbers = {1. + ranks.rank(), -2.};
  take_first(numbers);
  EXPECT_EQ(numbers, (std::vector<double>{1, -2}));
  EXPECT_EQ(of_first(0.5 + ranks.rank()), 0.5);
  EXPECT_TRUE(of_first(ranks.rank() == 0));
}

TEST(Agreement, TheErrorOfOneRankIsTold) {
  const Ranks ranks;
  const int last = ranks.size() - 1;
  EXPECT_EQ(error_of_any(ranks.rank() == last ? "a long sentence of the last one" : ""), "a long sentence of the last one");
  EXPECT_EQ(error_of_any(""), "");
}

}  // namespace
}  // namespace tanktread::coupling
