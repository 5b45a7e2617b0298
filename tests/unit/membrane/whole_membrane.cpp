#include "membrane/whole_membrane.hpp"

#include <cmath>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "spline/extraction.hpp"
#include "spline/t_mesh.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"

namespace tanktread::membrane {
namespace {

/// A unit sphere and an elongated shape.
struct Whole {
  spline::TMesh mesh = spline::cube(4);
  spline::Space space = spline::space(mesh, spline::ExtraordinaryRule::g1);
  Net unstressed = surface::resting_shape(space, mesh, {}), x = unstressed * Eigen::DiagonalMatrix<double, 3>(1.3, 0.9, 1.05), slant;
  std::vector<int> elements = std::vector<int>(space.elements.size());
  WholeMembrane whole;

  explicit Whole(double area_modulus = 7, double leaf_modulus = 3) : whole(space, unstressed, 1, {area_modulus, leaf_modulus, 1.2}) {
    std::iota(elements.begin(), elements.end(), 0);
    std::srand(1);
    slant = Net::Random(x.rows(), 3);
  }

  std::vector<Net> sums(const Net& at) const {
    std::vector<Net> all(whole.n_sums(), Net::Zero(at.rows(), 3));
    Net work = all[0];
    whole.add_work(at, elements, work, all);
    EXPECT_TRUE(work.isZero(0));
    return all;
  }
  Net load(const Net& at) const {
    Net d = Net::Zero(at.rows(), 3);
    whole.add_global_work(at, sums(at), d);
    return d;
  }
  double energy(const Net& at) const { return whole.energy(at, sums(at)); }
};

TEST(WholeMembrane, EnergyDependsOnTheTotalArea) {
  const Whole of(7, 0);
  const auto area = [&](const Net& net) { return surface::measures(of.space, net).area; };
  const double now = area(of.x), before = area(of.unstressed);
  EXPECT_NEAR(of.energy(of.x), 7 * (now - before) * (now - before) / (2 * before), 1e-8);
  EXPECT_NEAR(of.energy(of.unstressed), 0, 1e-25);
}

/// The integral of twice the mean curvature of an oblate spheroid is 4 pi (c + a^2 acos(c/a)/sqrt(a^2 - c^2)); the mesh is coarse.
TEST(WholeMembrane, EnergyDependsOnTheAreaDifferenceOfTheLeaflets) {
  const Whole of(0, 3);
  const double pi = std::numbers::pi, relaxed = 1.2 * 8 * pi;
  const auto expected = [&](double n) { return pi * 3 * (n - relaxed) * (n - relaxed) / (2 * 4 * pi); };
  EXPECT_NEAR(of.energy(of.unstressed) / expected(8 * pi), 1, 2e-3);
  EXPECT_NEAR(of.energy(2 * of.unstressed) / expected(16 * pi), 1, 2e-3);
  const Net spheroid = of.unstressed * Eigen::DiagonalMatrix<double, 3>(1, 1, 0.6);
  EXPECT_NEAR(of.energy(spheroid) / expected(4 * pi * (0.6 + std::acos(0.6) / 0.8)), 1, 5e-3);
}

TEST(WholeMembrane, LoadIsTheGradientOfTheEnergyWithZeroForceAndTorque) {
  const Whole of;
  const Net d = of.load(of.x);
  const double h = 1e-5;
  EXPECT_NEAR((of.energy(of.x + h * of.slant) - of.energy(of.x - h * of.slant)) / (2 * h), d.cwiseProduct(of.slant).sum(),
              1e-8 * d.norm() * of.slant.norm());
  EXPECT_LT(d.colwise().sum().norm(), 1e-11);
  EXPECT_GT(d.norm(), 0.1);
}

TEST(WholeMembrane, TangentIsTheDerivativeOfTheLoad) {
  Whole of;
  of.whole.linearise(of.x, of.elements, of.sums(of.x));
  Net hu = Net::Zero(of.x.rows(), 3);
  of.whole.add_tangent(of.slant, hu);
  of.whole.add_global_tangent(of.slant, hu);
  const double h = 1e-5;
  EXPECT_LT((hu - (of.load(of.x + h * of.slant) - of.load(of.x - h * of.slant)) / (2 * h)).norm(), 1e-8 * hu.norm());
}

/// If the stress-free area difference is the area difference of a sphere, the load equals the load of a spontaneous curvature and a tension.
TEST(WholeMembrane, AreaDifferenceActsLikeASpontaneousCurvatureAndATension) {
  const Whole of(0, 3);
  const double stiffness = 3 * std::numbers::pi / surface::measures(of.space, of.unstressed).area;
  const double change = std::sqrt(2 * of.energy(of.x) / stiffness), curvature = 0.3;  // N is smaller than its stress-free value
  const auto bent = [&](double c0) {
    return Membrane(of.space, of.unstressed, SurfaceTension{0}, 4, {1, false, c0}).load(of.x);
  };
  const Net tension = Membrane(of.space, of.unstressed, SurfaceTension{curvature * curvature / 2}).load(of.x);
  const Net expected = stiffness * change / curvature * (bent(curvature) - bent(0) - tension);
  const Net found = of.load(of.x);
  EXPECT_LT((found - expected).norm(), 1e-9 * found.norm());
}

}  // namespace
}  // namespace tanktread::membrane
