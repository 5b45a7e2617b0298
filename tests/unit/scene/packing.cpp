// Tests of spheres that are packed at random in a periodic cell.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include "scene/packing.hpp"

namespace tanktread {
namespace packing_test {

using std::numbers::pi;

/// Returns the smallest ratio of the distance of two spheres or images to the least distance that they must keep.
double closest(const std::vector<PackedSphere>& spheres, const stokes::PeriodicCell& cell) {
  double least = 1e9;
  for (std::size_t i = 0; i < spheres.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      const Vec3 apart = spheres[j].centre - spheres[i].centre, nearest = apart - cell.shift(apart);
      for (const Vec3& image : cell.around({2, 2, 2}))
        if (const double distance = (nearest + image).norm(); i != j || distance > 1e-9)
          least = std::min(least, distance / least_distance(spheres[i], spheres[j]));
    }
  return least;
}

/// Scene of `n` spheres at random positions in a cell of this shape, with the given volume fraction.
struct Scene {
  std::vector<PackedSphere> spheres;
  stokes::PeriodicCell cell;

  Scene(int n, double fraction, Mat3 shape, bool two_sizes = false) : cell(Mat3::Identity(), 3) {
    std::mt19937_64 random(7);
    double volume = 0;
    for (int k = 0; k < n; ++k) {
      PackedSphere& one = spheres.emplace_back();
      one.radius = two_sizes && k % 2 == 0 ? 0.6 : 1, one.least_gap = 0.05;
      volume += 4 * pi / 3 * std::pow(one.radius, 3);
    }
    cell = stokes::PeriodicCell(std::cbrt(volume / fraction / shape.determinant()) * shape, 3);
    for (PackedSphere& one : spheres) one.centre = cell.vectors() * Vec3(uniform(random), uniform(random), uniform(random));
  }
};

const Mat3 tilted = (Mat3() << 1, 0.2, 0.4, 0, 1.1, -0.3, 0, 0, 0.9).finished();

TEST(Packing, SpheresFillMoreThanNearlyHalfOfACellWithoutOverlap) {
  for (const double fraction : {0.2, 0.45, 0.5})
    for (const Mat3& shape : {Mat3(Mat3::Identity()), tilted})
      for (const int n : {20, 64}) {
        Scene scene(n, fraction, shape);
        ASSERT_TRUE(pack(scene.spheres, scene.cell, 1)) << fraction;
        EXPECT_GE(closest(scene.spheres, scene.cell), 1) << fraction << " " << n;
      }
}

TEST(Packing, TwoSizesAndFixedSpheres) {
  Scene scene(40, 0.4, tilted, true);
  scene.spheres[3].fixed = true;
  const Vec3 stays = scene.spheres[3].centre;
  ASSERT_TRUE(pack(scene.spheres, scene.cell, 1));
  EXPECT_GE(closest(scene.spheres, scene.cell), 1);
  EXPECT_EQ(scene.spheres[3].centre, stays);
}

TEST(Packing, IsReproducibleFromItsSeed) {
  const Scene start(20, 0.45, tilted);
  Scene one = start, other = start, third = start;
  ASSERT_TRUE(pack(one.spheres, one.cell, 1) && pack(other.spheres, other.cell, 1) && pack(third.spheres, third.cell, 2));
  EXPECT_EQ(one.spheres[7].centre, other.spheres[7].centre);
  EXPECT_NE(one.spheres[7].centre, third.spheres[7].centre);
}

/// At contact, the pair distribution of hard spheres in equilibrium is (1 - phi/2)/(1 - phi)^3 (Carnahan & Starling 1969). If spheres were only
/// pushed apart, nearly all would touch; if they were placed one after the other, fewer would.
TEST(Packing, IsThatOfHardSpheresInEquilibrium) {
  constexpr double fraction = 0.4;
  constexpr int n = 500;
  Scene scene(n, fraction / std::pow(1.025, 3), Mat3::Identity());
  ASSERT_TRUE(pack(scene.spheres, scene.cell, 1));
  constexpr double diameter = 2.05, beyond = 1.04;
  int close = 0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < i; ++j) {
      const Vec3 apart = scene.spheres[j].centre - scene.spheres[i].centre;
      close += (apart - scene.cell.shift(apart)).norm() < beyond * diameter;
    }
  const double shell = 4 * pi / 3 * std::pow(diameter, 3) * (std::pow(beyond, 3) - 1), density = n / scene.cell.volume();
  const double found = 2. * close / n / (shell * density), expected = (1 - fraction / 2) / std::pow(1 - fraction, 3);
  EXPECT_GT(found / expected, 0.75);  // the pair distribution decreases within a shell of this width
  EXPECT_LT(found / expected, 1.05);
}

TEST(Packing, SpheresThatDoNotFitAreReported) {
  Scene scene(20, 0.7, Mat3::Identity());
  EXPECT_FALSE(pack(scene.spheres, scene.cell, 1));
}

}  // namespace packing_test
}  // namespace tanktread
