#include "membrane/wall_repulsion.hpp"

#include <numeric>

#include <gtest/gtest.h>

#include "quadrature/gauss.hpp"
#include "spline/extraction.hpp"
#include "spline/t_mesh.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"

namespace tanktread::membrane {
namespace {

/// A unit sphere in a channel that narrows and widens, with the wall close to it everywhere.
struct Sphere {
  spline::TMesh mesh = spline::cube(4);
  spline::Space space = spline::space(mesh, spline::ExtraordinaryRule::g1);
  Net x = surface::resting_shape(space, mesh, {});
  std::vector<int> elements = std::vector<int>(space.elements.size());
  Repulsion wall{[](double s) { return 1.1 + 0.2 * std::sin(s + 0.3); }, 3.0, 0.1};
  WallRepulsion repulsion{space, x, wall};

  Sphere() { std::iota(elements.begin(), elements.end(), 0); }

  /// Returns the energy (3.22) in the shape y, by the quadrature of the load.
  double energy(const Net& y) const {
    double sum = 0;
    for (const int e : elements) {
      const quadrature::TensorRule& rule = quadrature::tensor_gauss(quadrature::gauss_order(4, space.elements[e].degree));
      for (int q = 0; q < rule.size(); ++q) {
        const spline::Site site{e, rule.s[q], rule.t[q]};
        const Vec3 at = surface::point(space, y, site).x;
        const double gap = wall.radius(at[0]) - std::hypot(at[1], at[2]);
        sum += rule.weights[q] * surface::point(space, x, site).jacobian * wall.stress * wall.range * std::exp(-gap / wall.range);
      }
    }
    return sum;
  }
};

TEST(WallRepulsion, LoadIsTheGradientOfTheEnergy) {
  const Sphere of;
  Net d = Net::Zero(of.x.rows(), 3);
  of.repulsion.add_work(of.x, of.elements, d, {});
  std::srand(1);
  for (int k = 0; k < 3; ++k) {
    const Net u = Net::Random(of.x.rows(), 3);
    const double h = 1e-5, slope = (of.energy(of.x + h * u) - of.energy(of.x - h * u)) / (2 * h);
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
