#include "surface/fit.hpp"

#include <random>

#include <gtest/gtest.h>

#include "spline/refinement.hpp"
#include "surfaces.hpp"

namespace tanktread::surface {
namespace {

/// Returns the largest distance between the affine image of a net, which is in the space, and its fit.
double defect(const spline::Space& space) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  const Net net = Net::NullaryExpr(space.n_points, 3, [&] { return any(random); });
  Mat3 map;
  map << 1.3, 0.4, -0.2, 0.1, 0.7, 0.5, -0.6, 0.2, 1.1;
  const Vec3 shift(0.3, -2, 5);
  const Net fitted = LeastSquaresFit(space).fit_image(net, [&](const Vec3& x) -> Vec3 { return map * x + shift; });
  return (fitted - ((net * map.transpose()).rowwise() + shift.transpose())).rowwise().norm().maxCoeff();
}

constexpr double round_off = 1e-11;  // for values up to 7, times the condition number of the matrix

TEST(LeastSquaresFit, ReproducesFieldsOfTheSpace) {
  EXPECT_LT(defect(CubeMesh(4).space), round_off);
  EXPECT_LT(defect(CubeMesh(11).space), round_off);
  EXPECT_LT(defect(CubeMesh(6, spline::ExtraordinaryRule::catmull_clark).space), round_off);
}

TEST(LeastSquaresFit, ReproducesFieldsOnElementsOfVeryDifferentSizes) {
  spline::TMesh mesh = spline::cube(5, 4);
  for (int k = 0; k < 4; ++k) mesh = spline::refine(mesh, {{5 * 2 + 2, true, true}}).mesh;
  EXPECT_LT(defect(spline::space(mesh, spline::ExtraordinaryRule::catmull_clark)), round_off);
}

TEST(LeastSquaresFit, ReproducesFieldsAtPoles) {
  for (const auto rule : {spline::PoleRule::plain, spline::PoleRule::bezier_transform, spline::PoleRule::c1})
    EXPECT_LT(defect(spline::space({12, 8, rule})), round_off);
}

}  // namespace
}  // namespace tanktread::surface
