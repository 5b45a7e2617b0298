// The layers of several particles at points off them are the sum of what each particle causes, and agree with the layers at points on them.

#include "system/targets/layer_pair.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "base/indices.hpp"
#include "spline/extraction.hpp"
#include "spline/t_mesh.hpp"
#include "surface/shapes.hpp"
#include "system/targets/collocation.hpp"

namespace tanktread::coupling {
namespace {

constexpr double viscosity = 1.7;

/// Two unit spheres with different viscosity ratios.
struct TwoSpheres {
  spline::TMesh mesh = spline::cube(3);
  spline::Space one = spline::space(mesh, spline::ExtraordinaryRule::g1), both;
  std::vector<Particle> particles{2};
  Net x, f, v;
  quadrature::Options quadrature;

  TwoSpheres() {
    const spline::Space* all[] = {&one, &one};
    both = spline::stacked(all);
    const std::vector<spline::Block> blocks = spline::blocks(all);
    x.resize(both.n_points, 3);
    for (std::size_t p = 0; p < 2; ++p) {
      particles[p].space = &one, particles[p].block = blocks[p], particles[p].viscosity_ratio = p == 0 ? 3 : 0.2;
      blocks[p].rows(x) = surface::resting_shape(one, mesh, {}).rowwise() + Eigen::RowVector3d(p == 0 ? -1.3 : 1.3, 0, 0);
    }
    f = x, v = x;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      f.row(i) << std::sin(x(i, 1)), x(i, 0) * x(i, 2), 1;
      v.row(i) << x(i, 1), 1 + x(i, 2), std::cos(x(i, 0));
    }
    quadrature.tolerance = 1e-8;
  }

  LayerPair layers(const stokes::Sites& points = {}) const {
    return LayerPair(both, points, x, particles, quadrature, viscosity);
  }
};

TEST(LayerPair, IsTheSumOfTheParticlesOffThem) {
  const TwoSpheres s;
  const Net at = (Net(3, 3) << 0, 0.2, 0.1, -2.4, 0.05, 0, 0.02, -0.1, 0.3).finished();  // at distances from 0.1 of the nearest sphere
  const std::vector<int> own{0, 2};
  LayerPair all = s.layers();
  all.set_shape(s.x);
  Net u = Net::Zero(3, 3), prepared = u, sum = u;
  all.add(s.f, s.v, {.at = at, .own = own}, u);
  all.add(s.f, s.v, all.prepared(at, own), prepared);
  EXPECT_LT((u - prepared).norm() / u.norm(), 1e-6);
  EXPECT_TRUE(u.row(1).isZero(0));
  for (Particle particle : s.particles) {
    const spline::Block block = particle.block;
    particle.block = spline::whole(s.one);
    LayerPair single(s.one, {}, block.rows(s.x), {&particle, 1}, s.quadrature, viscosity);
    single.set_shape(block.rows(s.x));
    const PointsOff points = single.prepared(at, own);
    single.add(block.rows(s.f), {}, points, sum), single.add({}, block.rows(s.v), points, sum);
  }
  EXPECT_LT((u - sum).norm() / u.norm(), 1e-6);
}

/// At points on a particle, the layers are the limit from outside.
TEST(LayerPair, OnTheParticlesIsTheLimitOffThem) {
  const TwoSpheres s;
  LayerPair off = s.layers(), on = s.layers(s.both.collocation);
  off.set_shape(s.x), on.set_shape(s.x);
  const std::vector<int> own{4};
  const Net sites = collocation_matrix(s.both) * s.x;
  Net u = Net::Zero(sites.rows(), 3), near = u;
  on.add(s.f, s.v, own, u);
  const Net centre = Eigen::RowVector3d(-1.3, 0, 0).replicate(sites.rows(), 1), out = centre + (1 + 1e-4) * (sites - centre);
  off.add(s.f, s.v, off.prepared(out, own), near);
  EXPECT_LT((near.row(4) - u.row(4)).norm() / u.row(4).norm(), 2e-3);
}

/// In the middle of a unit sphere, a uniform load f causes the velocity -2 f/(3 mu), and a uniform velocity v causes -(1 - lambda) v.
TEST(LayerPair, HasTheSignsAndFactorsOfTheEquation) {
  const TwoSpheres s;
  LayerPair layers = s.layers();
  layers.set_shape(s.x);
  const PointsOff middle{.at = Eigen::RowVector3d(-1.3, 0, 0), .own = {0}};
  Net f = Net::Zero(s.x.rows(), 3), of_load = Net::Zero(1, 3), of_velocity = of_load;
  s.particles[0].block.rows(f).col(0).setOnes();
  layers.add(f, {}, middle, of_load);
  layers.add({}, Eigen::RowVector3d(0, 1, 0).replicate(s.x.rows(), 1), middle, of_velocity);
  EXPECT_LT((of_load - Eigen::RowVector3d(-2 / (3 * viscosity), 0, 0)).norm(), 2e-3);
  EXPECT_LT((of_velocity - Eigen::RowVector3d(0, 2, 0)).norm(), 1e-4);
}

/// Integrals over a sphere: of 1, its area; of x.n, three times its volume, here times the viscosity contrasts.
TEST(LayerPair, WeightsAreIntegralsOverTheParticles) {
  const TwoSpheres s;
  LayerPair layers = s.layers();
  layers.set_shape(s.x);
  const Net ones = Net::Ones(s.x.rows(), 3);
  const Net area = layers.weights_of_load([](const Net& x) -> Net { return Eigen::RowVector3d(1, 0, 0).replicate(x.rows(), 1); });
  EXPECT_NEAR(area.cwiseProduct(ones).sum() / (8 * std::numbers::pi), 1, 2e-3);  // error of the fitted spheres
  const Net flux = layers.weights_of_velocity([](const Net&, const Net& n) { return n; });
  EXPECT_NEAR(flux.cwiseProduct(ones).sum(), 0, 1e-10);
  EXPECT_NEAR(flux.cwiseProduct(s.x).sum() / (4 * std::numbers::pi * (1 - 3 + 1 - 0.2)), 1, 3e-3);
}

}  // namespace
}  // namespace tanktread::coupling
