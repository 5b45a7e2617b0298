#include "base/small_matrices.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace tanktread {
namespace {

Mat3 matrix(double a, double b, double c, double d, double e, double f, double g, double h, double i) {
  return (Mat3() << a, b, c, d, e, f, g, h, i).finished();
}

TEST(SmallMatrices, ExponentialOfASpinIsARotationAndThatOfAShearIsAShear) {
  const Mat3 spin = matrix(0, -0.7, 0, 0.7, 0, 0, 0, 0, 0);
  EXPECT_LT((exponential(spin) - Mat3(Eigen::AngleAxisd(0.7, Vec3::UnitZ()))).norm(), 1e-15);
  EXPECT_LT((exponential(matrix(0, 3, 0, 0, 0, 0, 0, 0, 0)) - matrix(1, 3, 0, 0, 1, 0, 0, 0, 1)).norm(), 1e-15);
}

TEST(SmallMatrices, GrowthIsOfTheEigenvaluesAndStretchOfTheSingularValues) {
  const Mat3 shear = matrix(0, 2, 0, 0, 0, 0, 0, 0, 0), stretch = matrix(-1, 0, 0, 0, 3, 5, 0, 0, -2);
  EXPECT_NEAR(largest_growth_rate(shear), 0, 1e-15);
  EXPECT_NEAR(largest_stretch(shear), 2, 1e-15);
  EXPECT_NEAR(largest_growth_rate(stretch), 3, 1e-14);
  EXPECT_NEAR(largest_growth_rate(matrix(0, -4, 0, 4, 0, 0, 0, 0, -1)), 0, 1e-14);
}

TEST(SmallMatrices, NearestRotationIsThatOfAPolarDecompositionAndNeverAReflection) {
  const Mat3 turn(Eigen::AngleAxisd(1.2, Vec3(1, -2, 0.5).normalized()));
  const Mat3 stretch = matrix(2, 0.3, 0, 0.3, 1, -0.1, 0, -0.1, 0.5);
  EXPECT_LT((nearest_rotation(turn * stretch) - turn).norm(), 1e-14);
  const Mat3 mirrored = turn * stretch * Vec3(1, 1, -1).asDiagonal(), found = nearest_rotation(mirrored);
  EXPECT_NEAR(found.determinant(), 1, 1e-14);
  EXPECT_LT((found * found.transpose() - Mat3::Identity()).norm(), 1e-14);
}

}  // namespace
}  // namespace tanktread
