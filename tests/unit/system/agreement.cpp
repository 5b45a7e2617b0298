// Tests that the ranks agree on outcomes and decisions.

#include "system/parallel/agreement.hpp"

#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "system/parallel/ranks.hpp"

namespace tanktread::coupling {
namespace {

TEST(Agreement, AllRanksGetTheWorstOutcomeAndTheValuesOfTheFirstRank) {
  const Ranks ranks;
  EXPECT_EQ(largest(ranks.rank() + 1, "said by none, for all come"), ranks.size());
  EXPECT_EQ(largest(0), 0);
  std::vector<double> numbers = {1. + ranks.rank(), -2.};
  take_first(numbers);
  EXPECT_EQ(numbers, (std::vector<double>{1, -2}));
  EXPECT_EQ(of_first(0.5 + ranks.rank()), 0.5);
  EXPECT_TRUE(of_first(ranks.rank() == 0));
}

TEST(Agreement, OnlyTheFirstRankDecides) {
  const Ranks ranks;
  int calls = 0;
  EXPECT_EQ(decided([&] { return std::vector(static_cast<std::size_t>(++calls + 2), 1. + ranks.rank()); }), std::vector(3, 1.));
  EXPECT_EQ(calls, ranks.rank() == 0 ? 1 : 0);
  EXPECT_THROW(decided([]() -> std::vector<double> { throw std::logic_error("undecided"); }), RunFailure);
  EXPECT_TRUE(any_stop_requested(ranks.rank() == ranks.size() - 1));
  EXPECT_FALSE(any_stop_requested(false));
}

TEST(Agreement, TheWorstOutcomeHasAReason) {
  const Ranks ranks;
  const bool last = ranks.rank() == ranks.size() - 1;
  EXPECT_EQ(worst_of_all(last ? 2 : 0, last ? "why" : ""), std::pair(2, std::string("why")));
  EXPECT_EQ(worst_of_all(0, ""), std::pair(0, std::string()));
  EXPECT_EQ(failure_of_any([&] { if (last) throw std::runtime_error("one failed"); }), "one failed");
  EXPECT_EQ(failure_of_any([] {}), "");
}

TEST(Agreement, TheErrorOfOneRankIsReportedByAll) {
  const Ranks ranks;
  const int last = ranks.size() - 1;
  EXPECT_EQ(error_of_any(ranks.rank() == last ? "a long sentence of the last one" : ""), "a long sentence of the last one");
  EXPECT_EQ(error_of_any(""), "");
}

}  // namespace
}  // namespace tanktread::coupling
