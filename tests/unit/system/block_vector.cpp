// Tests of vectors of blocks: addresses, units, algebra and symmetry.

#include <cmath>
#include <cstdlib>
#include <limits>
#include <stdexcept>

#include <gtest/gtest.h>

#include "system/blocks/block_vector.hpp"
#include "system/blocks/tpetra.hpp"
#include "system/dynamics.hpp"

namespace tanktread::coupling {
namespace block_vector_test {

std::shared_ptr<const Layout> two_particles() {
  const auto scalars = [](const char* name, int on, int rows, double unit) { return Block{name, on, rows, 1, Parity::scalar, unit}; };
  return std::make_shared<Layout>(std::vector<Block>{{.name = "shape", .on = 0, .rows = 4},
                                                     {.name = "shape", .on = 1, .rows = 2},
                                                     scalars("concentration", 1, 5, 0.25),
                                                     scalars("pressure drop", -1, 1, 8)});
}

BlockVector random(const std::shared_ptr<const Layout>& layout, unsigned seed) {
  std::srand(seed);
  BlockVector vector(layout);
  vector.numbers().setRandom();
  return vector;
}

TEST(BlockVector, StoresBlocksOneAfterAnother) {
  BlockVector x(two_particles());
  ASSERT_EQ(x.numbers().size(), 12 + 6 + 5 + 1);
  EXPECT_EQ(x.norm(), 0);
  const BlockId second = x.layout()->id("shape", 1), drop = x.layout()->id("pressure drop", -1);
  x(second)(1, 2) = 3;
  x(drop)(0, 0) = 4;
  EXPECT_EQ(x.numbers()[12 + 5], 3);
  EXPECT_EQ(x.numbers()[12 + 6 + 5], 4);
  EXPECT_EQ(x.norm(), 5);
}

TEST(BlockVector, RefusesUnknownAndRepeatedBlocks) {
  EXPECT_THROW(two_particles()->id("shape", 2), std::logic_error);
  EXPECT_THROW(two_particles()->id("traction", 0), std::logic_error);
  EXPECT_THROW(Layout({{.name = "shape", .on = 0}, {.name = "shape", .on = 0}}), std::logic_error);
  EXPECT_THROW(Layout({{.name = "shape", .on = 0, .components = 2}}), std::logic_error);
}

TEST(BlockVector, StoresValuesDividedByTheUnit) {
  BlockVector x(two_particles());
  const BlockId c = x.layout()->id("concentration", 1);
  const Eigen::VectorXd value = Eigen::VectorXd::LinSpaced(5, 1, 2);
  x.set(c, value);
  EXPECT_EQ(Eigen::VectorXd(x(c)), value / 0.25);
  EXPECT_EQ(Eigen::VectorXd(x.value(c)), value);
}

TEST(BlockVector, CopiesAreValues) {
  BlockVector x = random(two_particles(), 1), y = x;
  EXPECT_TRUE(x == y);
  y *= 2;
  EXPECT_EQ(y.norm(), 2 * x.norm());
  const BlockVector moved = std::move(y);
  EXPECT_TRUE(y.empty());
  EXPECT_EQ(moved.norm(), 2 * x.norm());
}

TEST(BlockVector, MayBeAbsent) {
  BlockVector absent, x = random(two_particles(), 1);
  EXPECT_TRUE(absent.empty());
  EXPECT_EQ(absent.numbers().size(), 0);
  EXPECT_EQ(dot(absent, x), 0);
  EXPECT_FALSE(absent == x);
  EXPECT_TRUE(BlockVector(absent).empty());
  x = absent;
  EXPECT_TRUE(x.empty());
}

TEST(BlockVector, CombinesNumbers) {
  const BlockVector x = random(two_particles(), 1), y = random(x.layout(), 2), z = random(x.layout(), 3);
  const BlockVector sum = 2 * (x - y) + z / 4;
  EXPECT_LT((sum.numbers() - (2 * x.numbers() - 2 * y.numbers() + 0.25 * z.numbers())).norm(), 1e-15);
  BlockVector same = z;
  same *= 0.25;
  same += 2 * x;
  same -= 2 * y;
  EXPECT_LT(BlockVector(same - sum).norm(), 1e-15);
  EXPECT_NEAR(dot(x, 2 * y), 2 * x.numbers().dot(y.numbers()), 1e-15);
}

TEST(BlockVector, NoticesNumbersThatAreNotFinite) {
  BlockVector x = random(two_particles(), 1);
  EXPECT_TRUE(x.allFinite());
  x.numbers()[7] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(x.allFinite());
}

TEST(BlockVector, SharesItsNumbersWithTpetra) {
  BlockVector x = random(two_particles(), 1);
  tpetra_of(x).scale(2);
  EXPECT_EQ(x.norm(), 2 * random(x.layout(), 1).norm());
  EXPECT_EQ(column(tpetra_of(x)), x.numbers());
}

/// Three points, of which the mirror plane x1 = 0 exchanges the first two and contains the third; a field of two coefficients, which the mirror
/// plane exchanges with opposite sign; and one that does not know its images.
struct Mirrored {
  explicit Mirrored(const Vec3& of_planes = Vec3::Ones()) {
    surface::Image mirror;
    mirror.signs = Vec3(-1, 1, 1);
    mirror.point = {1, 0, 2};
    symmetry = surface::Symmetry({mirror}, (Net(3, 3) << -1, 0, 0, 1, 0, 0, 0, 0, 1).finished());
    const auto images = [](BlockId id, const surface::Image& g) {
      return id.at < 3 ? images_of_points(g) : id.at == 3 ? RowImages{{1, -1}, {0, -1}} : RowImages();
    };
    layout = std::make_shared<Layout>(std::vector<Block>{{.name = "velocity", .rows = 3},
                                                         {.name = "rotation", .rows = 3, .parity = Parity::axial},
                                                         {.name = "tension", .rows = 3, .components = 1, .parity = Parity::scalar},
                                                         {.name = "strain", .rows = 2, .components = 1, .parity = Parity::scalar},
                                                         {.name = "other", .rows = 2, .components = 1, .parity = Parity::scalar}},
                                      symmetry, images, of_planes);
  }

  surface::Symmetry symmetry;
  std::shared_ptr<const Layout> layout;
};

TEST(Layout, CompletesBlocksByTheirParity) {
  const Mirrored mirrored;
  BlockVector x = random(mirrored.layout, 1);
  const BlockVector before = x;
  Net velocity = x(BlockId{0});
  mirrored.layout->complete(x);
  mirrored.symmetry.complete(velocity);  // the symmetry's own rule for vectors
  EXPECT_EQ(Net(x(BlockId{0})), velocity);
  const auto row = [&](std::size_t block, int i) { return Eigen::VectorXd(x(BlockId{block}).row(i).transpose()); };
  EXPECT_EQ(row(1, 0), Vec3(1, -1, -1).cwiseProduct(Vec3(row(1, 1))));
  EXPECT_EQ(row(1, 2)[1], 0);
  EXPECT_EQ(row(1, 2)[0], before(BlockId{1})(2, 0));
  EXPECT_EQ(row(2, 0), row(2, 1));
  EXPECT_EQ(row(2, 1)[0], before(BlockId{2})(1, 0));
  EXPECT_EQ(row(3, 0), -row(3, 1));
  EXPECT_EQ(x(BlockId{4}), before(BlockId{4}));
}

TEST(Layout, CompletesAntisymmetricVectors) {
  const Mirrored odd(Vec3(-1, 1, 1));
  BlockVector x = random(odd.layout, 1);
  odd.layout->complete(x);
  EXPECT_EQ(Vec3(x(BlockId{0}).row(0)), Vec3(1, -1, -1).cwiseProduct(Vec3(x(BlockId{0}).row(1))));
  EXPECT_EQ(x(BlockId{2})(2, 0), 0);
  EXPECT_EQ(x(BlockId{3})(0, 0), x(BlockId{3})(1, 0));
}

TEST(Layout, ProjectsOnSymmetricVectors) {
  const Mirrored even, odd(Vec3(-1, 1, 1));
  const BlockVector x = random(even.layout, 1);
  BlockVector symmetric = x, antisymmetric(odd.layout);
  antisymmetric.numbers() = x.numbers();
  even.layout->project(symmetric);
  odd.layout->project(antisymmetric);
  BlockVector again = symmetric;
  even.layout->complete(again);
  EXPECT_TRUE(again == symmetric);
  for (const std::size_t k : {0u, 1u, 2u, 3u})  // every vector is the sum of a symmetric and an antisymmetric vector
    EXPECT_LT((symmetric(BlockId{k}) + antisymmetric(BlockId{k}) - x(BlockId{k})).norm(), 1e-15);
  EXPECT_NEAR(symmetric.numbers().head(23).dot(antisymmetric.numbers().head(23)), 0, 1e-15);
}

TEST(Layout, SymmetricVectorsFollowFromTheirIndependentNumbers) {
  const Mirrored mirrored;
  const BlockVector values = random(mirrored.layout, 1);
  BlockVector x(mirrored.layout);
  std::vector<std::size_t> counts;
  for (std::size_t k = 0; k < mirrored.layout->blocks().size(); ++k) {
    const auto numbers = mirrored.layout->independent({k});
    counts.push_back(numbers.size());
    for (const auto& [number, orbit] : numbers) x.numbers()[number] = values.numbers()[number];
  }
  EXPECT_EQ(counts, (std::vector<std::size_t>{5, 4, 2, 1, 2}));  // the third point has two components of a vector and one of an axial vector
  mirrored.layout->complete(x);
  BlockVector again = x;
  mirrored.layout->project(again);
  EXPECT_LT(BlockVector(again - x).norm(), 1e-15);
  double square = 0;
  for (std::size_t k = 0; k < counts.size(); ++k)
    for (const auto& [number, orbit] : mirrored.layout->independent({k})) square += orbit * std::pow(x.numbers()[number], 2);
  EXPECT_NEAR(square, dot(x, x), 1e-14);
}

TEST(BlockVector, RigidMotionsMoveVectorsOnly) {
  BlockVector x = random(two_particles(), 1);
  const Mat3 turn = Eigen::AngleAxisd(0.3, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const BlockVector rate = moved(x, {Vec3(1, 2, 3), Vec3(0.1, 0, 0.2)}), there = turned(x, turn);
  EXPECT_EQ(Net(rate(BlockId{1})), rigid_velocity(x(BlockId{1}), {Vec3(1, 2, 3), Vec3(0.1, 0, 0.2)}, Vec3::Zero()));
  EXPECT_EQ(rate(BlockId{2}).norm(), 0);
  EXPECT_LT((there(BlockId{0}) * turn - x(BlockId{0})).norm(), 1e-14);
  EXPECT_EQ(there(BlockId{3}), x(BlockId{3}));
}

}  // namespace block_vector_test
}  // namespace tanktread::coupling
