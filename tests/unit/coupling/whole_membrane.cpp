#include "coupling/whole_membrane.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "spline/extraction.hpp"
#include "spline/t_mesh.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"

namespace tanktread::coupling {
namespace {

/// Two unit spheres, drawn out, one of which resists.
struct Pair {
  spline::TMesh mesh = spline::cube(4);
  spline::Space one = spline::space(mesh, spline::ExtraordinaryRule::g1);
  spline::Space both = spline::stacked(std::array<const spline::Space*, 2>{&one, &one});
  std::array<Particle, 2> particles;
  Net unstressed, x, slant;
  std::vector<int> elements = std::vector<int>(both.elements.size());

  explicit Pair(double area_modulus = 7, double leaf_modulus = 3) {
    for (Particle& particle : particles) particle.space = &one;
    place(particles);
    particles[0].global_area_modulus = area_modulus;
    particles[0].leaf_modulus = leaf_modulus;
    particles[0].leaf_difference = 1.2;
    const Net sphere = surface::initial_shape(one, mesh, {});
    unstressed.resize(both.n_points, 3);
    for (const Particle& particle : particles) particle.block.rows(unstressed) = sphere;
    x = unstressed * Eigen::DiagonalMatrix<double, 3>(1.3, 0.9, 1.05);
    std::iota(elements.begin(), elements.end(), 0);
    std::srand(1);
    slant = Net::Random(x.rows(), 3);
  }

  Net load(const WholeMembrane& whole, const Net& at) const {
    Net d = Net::Zero(at.rows(), 3);
    whole.add_load(at, whole.gradients(at, elements), d);
    return d;
  }
  double energy(const WholeMembrane& whole, const Net& at, std::size_t p = 0) const { return whole.energy(at, whole.gradients(at, elements), p); }
};

TEST(WholeMembrane, EnergyIsOfTheWholeArea) {
  const Pair of(7, 0);
  const WholeMembrane whole(of.both, of.unstressed, of.particles);
  const auto area = [&](const Net& net) { return surface::measures(of.one, of.particles[0].block.rows(net)).area; };
  const double now = area(of.x), before = area(of.unstressed);
  EXPECT_NEAR(of.energy(whole, of.x), 7 * (now - before) * (now - before) / (2 * before), 1e-8);
  EXPECT_EQ(of.energy(whole, of.x, 1), 0);
  EXPECT_NEAR(of.energy(whole, of.unstressed), 0, 1e-25);
}

/// 4 pi (c + a^2 acos(c/a)/sqrt(a^2 - c^2)) is the integral of twice the mean curvature of an oblate spheroid; the mesh is coarse.
TEST(WholeMembrane, EnergyIsOfTheDifferenceOfTheLeaves) {
  const Pair of(0, 3);
  const WholeMembrane whole(of.both, of.unstressed, of.particles);
  const double pi = std::numbers::pi, relaxed = 1.2 * 8 * pi;
  const auto expected = [&](double n) { return pi * 3 * (n - relaxed) * (n - relaxed) / (2 * 4 * pi); };
  EXPECT_NEAR(of.energy(whole, of.unstressed) / expected(8 * pi), 1, 2e-3);
  EXPECT_NEAR(of.energy(whole, 2 * of.unstressed) / expected(16 * pi), 1, 2e-3);
  const Net spheroid = of.unstressed * Eigen::DiagonalMatrix<double, 3>(1, 1, 0.6);
  EXPECT_NEAR(of.energy(whole, spheroid) / expected(4 * pi * (0.6 + std::acos(0.6) / 0.8)), 1, 5e-3);
}

TEST(WholeMembrane, LoadIsTheGradientOfTheEnergyAndPullsNothingAway) {
  const Pair of;
  const WholeMembrane whole(of.both, of.unstressed, of.particles);
  const Net d = of.load(whole, of.x);
  const double h = 1e-5;
  EXPECT_NEAR((of.energy(whole, of.x + h * of.slant) - of.energy(whole, of.x - h * of.slant)) / (2 * h), d.cwiseProduct(of.slant).sum(),
              1e-8 * d.norm() * of.slant.norm());
  EXPECT_LT(d.colwise().sum().norm(), 1e-11);
  EXPECT_GT(of.particles[0].block.rows(d).norm(), 0.1);
  EXPECT_EQ(of.particles[1].block.rows(d).norm(), 0);
}

TEST(WholeMembrane, TangentIsTheDerivativeOfTheLoad) {
  const Pair of;
  WholeMembrane whole(of.both, of.unstressed, of.particles);
  whole.update(of.x, whole.gradients(of.x, of.elements), of.elements);
  Net hu = Net::Zero(of.x.rows(), 3);
  whole.add_turning(of.slant, hu);
  whole.add_stretching(of.slant, hu);
  const double h = 1e-5;
  EXPECT_LT((hu - (of.load(whole, of.x + h * of.slant) - of.load(whole, of.x - h * of.slant)) / (2 * h)).norm(), 1e-8 * hu.norm());
}

/// Difference without stress as of a sphere: what acts is that of a spontaneous curvature, and a tension.
TEST(WholeMembrane, LeavesActLikeASpontaneousCurvature) {
  const Pair of(0, 3);
  const WholeMembrane whole(of.both, of.unstressed, of.particles);
  const double stiffness = 3 * std::numbers::pi / surface::measures(of.one, of.unstressed.topRows(of.one.n_points)).area;
  const double change = std::sqrt(2 * of.energy(whole, of.x) / stiffness), curvature = 0.3;  // N is the smaller one
  const auto bent = [&](double c0) {
    return membrane::Membrane(of.both, of.unstressed, membrane::SurfaceTension{0}, 4, {1, false, c0}).load(of.x);
  };
  const Net tension = membrane::Membrane(of.both, of.unstressed, membrane::SurfaceTension{curvature * curvature / 2}).load(of.x);
  const Net expected = stiffness * change / curvature * (bent(curvature) - bent(0) - tension);
  const Net found = of.load(whole, of.x);
  EXPECT_LT((of.particles[0].block.rows(found) - of.particles[0].block.rows(expected)).norm(), 1e-9 * found.norm());
}

}  // namespace
}  // namespace tanktread::coupling
