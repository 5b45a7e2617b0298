#include "surface/partition.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "base/indices.hpp"
#include "surfaces.hpp"

namespace tanktread::surface {
namespace {

Partition partition(const spline::Space& space, int parts) { return partition_of_points(space, parts, indices(space.n_points)); }

TEST(Partition, OnePartOwnsEverything) {
  const CubeMesh cube(3);
  const Share all = share(cube.space, partition(cube.space, 1), 0);
  EXPECT_EQ(static_cast<int>(all.points.size()), cube.space.n_points);
  EXPECT_EQ(all.elements.size(), cube.space.elements.size());
}

TEST(Partition, BalancesElementsAndPoints) {
  const CubeMesh cube(8);
  const double n = static_cast<double>(cube.space.elements.size());
  for (const int parts : {2, 3, 4, 7, 12}) {
    const Partition p = partition(cube.space, parts);
    std::vector<int> elements(parts, 0), points(parts, 0);
    for (const int owner : p.element_owner) ++elements[owner];
    EXPECT_LT(*std::max_element(elements.begin(), elements.end()), 1.08 * n / parts) << parts;
    for (const int owner : p.point_owner) ++points[owner];
    EXPECT_LT(*std::max_element(points.begin(), points.end()), 1.05 * cube.space.n_points / parts) << parts;
  }
}

TEST(Partition, SharesCoverEveryPointOnceWithAllElementsThatTouchIt) {
  const CubeMesh cube(5);
  const Partition p = partition(cube.space, 4);
  std::vector<int> owned(cube.space.n_points, 0);
  for (int rank = 0; rank < 4; ++rank) {
    const Share mine = share(cube.space, p, rank);
    EXPECT_TRUE(std::is_sorted(mine.points.begin(), mine.points.end()));
    EXPECT_TRUE(std::is_sorted(mine.elements.begin(), mine.elements.end()));
    for (const int a : mine.points) ++owned[a];
    for (int e = 0; e < static_cast<int>(cube.space.elements.size()); ++e) {
      const auto& points = cube.space.elements[e].points;
      const bool touches = std::any_of(points.begin(), points.end(), [&](int a) { return p.point_owner[a] == rank; });
      EXPECT_EQ(touches, std::binary_search(mine.elements.begin(), mine.elements.end(), e));
    }
  }
  for (const int count : owned) EXPECT_EQ(count, 1);
}

TEST(Partition, PartsAreCompactEnoughThatSharesOverlapLittle) {
  const CubeMesh cube(12);
  const Partition p = partition(cube.space, 2);
  std::size_t sum = 0;
  for (int rank = 0; rank < 2; ++rank) sum += share(cube.space, p, rank).elements.size();
  // Four rows of elements along a cut of about 48 elements are evaluated twice: less than a third of 864.
  EXPECT_LT(sum, 4 * cube.space.elements.size() / 3);
}

TEST(Partition, IsTheSameEveryTime) {
  const CubeMesh cube(6);
  const Partition a = partition(cube.space, 5), b = partition(cube.space, 5);
  EXPECT_EQ(a.element_owner, b.element_owner);
  EXPECT_EQ(a.point_owner, b.point_owner);
}

TEST(Partition, MorePartsThanElementsAreRejected) {
  const CubeMesh cube(3);
  EXPECT_THROW(partition(cube.space, 55), UserError);
}

}  // namespace
}  // namespace tanktread::surface
