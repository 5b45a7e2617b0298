#include "system/solvers/secants.hpp"

#include <gtest/gtest.h>

namespace tanktread::coupling {
namespace {

Net net(unsigned seed, Eigen::Index n = 20) {
  std::srand(seed);
  return Net::Random(n, 3);
}

TEST(Secants, AreEmptyAtFirst) { EXPECT_EQ(Secants()(net(1)).norm(), 0); }

TEST(Secants, ReproduceStoredPairsAtAnyScale) {
  Secants secants;
  for (unsigned k : {1u, 2u, 3u}) secants.add(1e-3 * net(k), 1e-3 * net(10 + k), 3);
  for (unsigned k : {1u, 2u, 3u})  // tolerance: twice the regularisation 1e-2 of the least-squares fit
    EXPECT_LT((secants(net(k)) - net(10 + k)).norm(), 2e-2 * net(10 + k).norm());
}

TEST(Secants, DoNotChangeVectorsOrthogonalToAllPairs) {
  Secants secants;
  Net x = Net::Zero(20, 3), y = x;
  x.col(0).setRandom();
  y.col(1).setRandom();
  secants.add(x, net(3), 2);
  EXPECT_EQ(secants(y).norm(), 0);
}

TEST(Secants, KeepTheLatestPairs) {
  Secants secants;
  for (unsigned k : {1u, 2u, 3u}) secants.add(net(k), net(10 + k), 2);
  ASSERT_EQ(secants.pairs().size(), 4u);
  EXPECT_LT((secants.pairs()[0] - net(2) / net(2).norm()).norm(), 1e-15);
}

TEST(Secants, StayBoundedForParallelCorrections) {
  Secants secants;
  secants.add(net(1), net(2), 2);
  secants.add(net(1), net(3), 2);  // the same correction with another error: the result is the mean of both errors
  EXPECT_LT((secants(net(1)) - 0.5 * (net(2) + net(3))).norm(), 2e-2 * net(2).norm());
}

TEST(Secants, ContinueBitwiseEqualFromStoredPairs) {
  Secants secants;
  for (unsigned k : {1u, 2u}) secants.add(net(k), net(10 + k), 2);
  EXPECT_EQ((Secants(secants.pairs())(net(5)) - secants(net(5))).norm(), 0);
}

}  // namespace
}  // namespace tanktread::coupling
