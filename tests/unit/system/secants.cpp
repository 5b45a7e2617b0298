#include "system/solvers/secants.hpp"
#include "tests/states.hpp"

#include <gtest/gtest.h>

namespace tanktread::coupling {
namespace {

State state(unsigned seed) {
  std::srand(seed);
  return state_of(Net::Random(20, 3));
}

TEST(Secants, AreEmptyAtFirst) { EXPECT_EQ(Secants()(state(1)).norm(), 0); }

TEST(Secants, ReproduceStoredPairsAtAnyScale) {
  Secants secants;
  for (unsigned k : {1u, 2u, 3u}) secants.add(1e-3 * state(k), 1e-3 * state(10 + k), 3);
  for (unsigned k : {1u, 2u, 3u})  // tolerance: twice the regularisation 1e-2 of the least-squares fit
    EXPECT_LT(State(secants(state(k)) - state(10 + k)).norm(), 2e-2 * state(10 + k).norm());
}

TEST(Secants, DoNotChangeVectorsOrthogonalToAllPairs) {
  Secants secants;
  Net x = Net::Zero(20, 3), y = x;
  x.col(0).setRandom();
  y.col(1).setRandom();
  secants.add(state_of(x), state(3), 2);
  EXPECT_EQ(secants(state_of(y)).norm(), 0);
}

TEST(Secants, KeepTheLatestPairs) {
  Secants secants;
  for (unsigned k : {1u, 2u, 3u}) secants.add(state(k), state(10 + k), 2);
  ASSERT_EQ(secants.pairs().size(), 4u);
  EXPECT_LT(State(secants.pairs()[0] - state(2) / state(2).norm()).norm(), 1e-15);
}

TEST(Secants, StayBoundedForParallelCorrections) {
  Secants secants;
  secants.add(state(1), state(2), 2);
  secants.add(state(1), state(3), 2);  // the same correction with another error: the result is the mean of both errors
  EXPECT_LT(State(secants(state(1)) - 0.5 * (state(2) + state(3))).norm(), 2e-2 * state(2).norm());
}

TEST(Secants, ContinueBitwiseEqualFromStoredPairs) {
  Secants secants;
  for (unsigned k : {1u, 2u}) secants.add(state(k), state(10 + k), 2);
  EXPECT_EQ(State(Secants(secants.pairs())(state(5)) - secants(state(5))).norm(), 0);
}

}  // namespace
}  // namespace tanktread::coupling
