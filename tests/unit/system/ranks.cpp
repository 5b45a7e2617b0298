// Tests of rows and sums over any number of ranks.

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "system/parallel/ranks.hpp"

namespace tanktread::coupling {
namespace {

TEST(Ranks, EveryRankGetsAllRows) {
  Ranks ranks;
  const int n = 23;
  std::vector<int> mine;
  for (int i = 0; i < n; ++i)
    if (i * 7 % 11 % ranks.size() == ranks.rank()) mine.push_back(i);
  ranks.set_owned_rows(mine, surface::Symmetry(n));
  Net net = Net::Constant(n, 3, -1);
  for (const int i : mine) net.row(i) << i, 10 * i, 100 * i;
  ranks.replicate(net);
  for (int i = 0; i < n; ++i) EXPECT_EQ(net.row(i), Eigen::RowVector3d(i, 10 * i, 100 * i));
}

TEST(Ranks, ContributionsAreSummed) {
  Ranks ranks;
  ranks.set_owned_rows(ranks.rank() == 0 ? std::vector<int>{0, 1, 2, 3, 4} : std::vector<int>{}, surface::Symmetry(5));
  Net a = Net::Constant(5, 3, 1 + ranks.rank()), b = Net::Zero(5, 3);
  int owners = 0;
  for (int k = 0; k < 15; ++k) {
    if (ranks.owner(k, 15) == ranks.rank()) b(k / 3, k % 3) = 0.1 * k;
    if (k > 0) owners += ranks.owner(k, 15) != ranks.owner(k - 1, 15);
  }
  Net* const both[] = {&a, &b};
  ranks.add(both);
  EXPECT_EQ(owners, std::min(ranks.size(), 15) - 1);
  for (int k = 0; k < 15; ++k) {
    EXPECT_EQ(a(k / 3, k % 3), ranks.size() * (ranks.size() + 1) / 2);
    EXPECT_EQ(b(k / 3, k % 3), 0.1 * k);
  }
}

TEST(Ranks, EveryItemIsDoneByOneRankAndNumbersAddUp) {
  const Ranks ranks;
  std::vector<double> mine(7, 0);
  for (const int k : ranks.share(7)) mine[static_cast<std::size_t>(k)] = 0.1 * k;
  const auto [done, weight] = ranks.of_all(std::array{mine, std::vector<double>(3, 1)});
  for (std::size_t k = 0; k < done.size(); ++k) EXPECT_EQ(done[k], 0.1 * static_cast<double>(k));  // sums of one value and zeros are exact
  for (const double w : weight) EXPECT_EQ(w, ranks.size());
}

TEST(Ranks, RowsAreEvaluatedByOneRankEach) {
  const Ranks ranks;
  const auto rows = ranks.divided<Eigen::MatrixXd>(7, 2, [](std::span<const int> own, Eigen::MatrixXd& all) {
    for (const int k : own) all.row(k) << k + 1, 2 * k;
  });
  for (int k = 0; k < 7; ++k) EXPECT_EQ(rows.row(k), Eigen::RowVector2d(k + 1, 2 * k));
  EXPECT_EQ(ranks.assembled<Eigen::MatrixXd>(2, 2, [](Eigen::MatrixXd& own) { own.diagonal().setOnes(); }),
            ranks.size() * Eigen::MatrixXd::Identity(2, 2));
  const auto all = ranks.gathered(std::array{1. + ranks.rank(), 5.});
  for (std::size_t r = 0; r < all.size(); ++r) EXPECT_EQ(all[r], (std::array{1. + static_cast<double>(r), 5.}));
}

TEST(Ranks, OwnersFillTheRowsOfTheirPoints) {
  Ranks ranks;
  const std::vector<int> own = ranks.divide_in_order(surface::Symmetry(9));
  const Net net = ranks.filled(9, [&](Net& rows) {
    for (const int a : own) rows.row(a) << a, 1, -a;
  });
  for (int a = 0; a < 9; ++a) EXPECT_EQ(net.row(a), Eigen::RowVector3d(a, 1, -a));
}

TEST(Ranks, AConditionOnOneRankIsKnownToAll) {
  Ranks ranks;
  EXPECT_TRUE(any_stop_requested(ranks.rank() == ranks.size() - 1));
  EXPECT_FALSE(any_stop_requested(false));
}

}  // namespace
}  // namespace tanktread::coupling
