#include "membrane/wall_repulsion.hpp"

#include <numeric>

#include <gtest/gtest.h>

#include "spline/extraction.hpp"
#include "spline/t_mesh.hpp"
#include "surface/shapes.hpp"

namespace tanktread::membrane {
namespace {

/// A unit sphere in a channel that narrows and widens, with the wall close to it everywhere.
struct Sphere {
  spline::TMesh mesh = spline::cube(4);
  spline::Space space = spline::space(mesh, spline::ExtraordinaryRule::g1);
  Net x = surface::resting_shape(space, mesh, {});
  std::vector<int> elements = std::vector<int>(space.elements.size());
  WallRepulsion repulsion{space, x, {[](double s) { return 1.1 + 0.2 * std::sin(s + 0.3); }, 3.0, 0.1}};

  Sphere() { std::iota(elements.begin(), elements.end(), 0); }
};

TEST(WallRepulsion, LoadIsTheGradientOfTheEnergy) {
  const Sphere of;
  Net d = Net::Zero(of.x.rows(), 3);
  of.repulsion.add_work(of.x, of.elements, d, {});
  std::srand(1);
  for (int k = 0; k < 3; ++k) {
    const Net u = Net::Random(of.x.rows(), 3);
    const double h = 1e-5, slope = (of.repulsion.potential(of.x + h * u, of.elements) - of.repulsion.potential(of.x - h * u, of.elements)) / (2 * h);
    EXPECT_NEAR((d.array() * u.array()).sum(), slope, 1e-7 * d.norm() * u.norm());  // error of the differences, including that of the wall's slope
  }
  EXPECT_GT(d.norm(), 0.1);
}

// The tangent neglects the rotation of the normals, a relative error of order range/radius.
TEST(WallRepulsion, TangentIsSymmetricAndNearlyTheDerivativeOfTheLoad) {
  Sphere of;
  of.repulsion.linearise(of.x, of.elements, {});
  std::srand(2);
  const Net u = Net::Random(of.x.rows(), 3), v = Net::Random(of.x.rows(), 3);
  Net hu = Net::Zero(of.x.rows(), 3), hv = hu, ahead = hu, behind = hu;
  of.repulsion.add_tangent(u, hu);
  of.repulsion.add_tangent(v, hv);
  EXPECT_NEAR((hu.array() * v.array()).sum(), (hv.array() * u.array()).sum(), 1e-12 * hu.norm() * v.norm());
  EXPECT_GT((hu.array() * u.array()).sum(), 0);
  const double h = 1e-5;
  of.repulsion.add_work(of.x + h * u, of.elements, ahead, {});
  of.repulsion.add_work(of.x - h * u, of.elements, behind, {});
  EXPECT_LT((hu - (ahead - behind) / (2 * h)).norm(), 0.15 * hu.norm());
}

TEST(WallRepulsion, OnTheAxisThereIsNoForceAcrossIt) {
  Sphere of;
  Net x = of.x, d = Net::Zero(x.rows(), 3), hu = d;
  x.rightCols(2).setZero();
  of.repulsion.add_work(x, of.elements, d, {});
  of.repulsion.linearise(x, of.elements, {});
  of.repulsion.add_tangent(of.x, hu);
  EXPECT_TRUE(d.allFinite() && hu.allFinite());
  EXPECT_TRUE(d.rightCols(2).isZero(0));
  EXPECT_GT(d.col(0).norm(), 0);
}

TEST(WallRepulsion, PartsAddUpToTheWhole) {
  const Sphere of;
  const std::span<const int> all(of.elements);
  Net whole = Net::Zero(of.x.rows(), 3), parts = whole;
  of.repulsion.add_work(of.x, all, whole, {});
  of.repulsion.add_work(of.x, all.first(40), parts, {});
  of.repulsion.add_work(of.x, all.subspan(40), parts, {});
  EXPECT_EQ(whole, parts);
}

}  // namespace
}  // namespace tanktread::membrane
