// Tests of the layers of a surface at points off the surface: identities, and agreement of all ways to evaluate the layers.

#include <cmath>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "spline/extraction.hpp"
#include "spline/t_mesh.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"
#include "tests/layers.hpp"
#include "tests/verify/layers_reference.hpp"

namespace tanktread::stokes {
namespace {

struct Fixture {
  spline::TMesh mesh = spline::cube(3);
  spline::Space space = spline::space(mesh, spline::ExtraordinaryRule::g1);
  Net x, f, at;
  std::vector<int> all;
  quadrature::Options options;

  Fixture() {
    surface::ParticleShape shape;
    shape.shape = "ellipsoid";
    shape.semi_axes = Vec3(1, 0.8, 0.7);
    x = surface::resting_shape(space, mesh, shape);
    f = Net(x.rows(), 3);
    for (Eigen::Index i = 0; i < f.rows(); ++i) f.row(i) << 1 + x(i, 1), x(i, 0) * x(i, 2), std::sin(x(i, 2));
    at.resize(4, 3);
    at << 1.02, 0.1, 0, 2, 1, -1, 0.1, -0.85, 0.1, 0.4, 0.3, 1.5;
    all.resize(4);
    std::iota(all.begin(), all.end(), 0);
    options.tolerance = 1e-8;
  }
};

TEST(CrossLayer, IsTheIntegral) {
  const Fixture s;
  const verify::BruteForce surface(s.space, s.x);
  std::vector<verify::Casteljau> field;
  for (const spline::Element& e : s.space.elements) field.emplace_back(e, s.f);
  for (const auto kernel : {CrossLayer::Kernel::single_layer, CrossLayer::Kernel::double_layer}) {
    CrossLayer layer(s.space, s.options, kernel);
    layer.set_shape(s.x);
    Net u(4, 3);
    layer.apply(s.f, s.at, s.all, u);
    for (int i = 0; i < 4; ++i) {
      const Vec3 y = s.at.row(i).transpose();
      const Vec3 exact = surface.integrate(y, {}, [&](const verify::SurfacePoint& p) -> Vec3 {
        const Mat3 g = kernel == CrossLayer::Kernel::single_layer ? stokeslet(p.x - y) : stresslet(p.x - y, p.normal);
        return g * field[p.element](p.s, p.t)[0] / (8 * std::numbers::pi);
      });
      EXPECT_LT((u.row(i).transpose() - exact).norm(), 2e-8) << i;
    }
  }
}

TEST(CrossLayer, IsItsAssembledRows) {
  Fixture s;
  for (const auto rule : {quadrature::LayerRule::adaptive, quadrature::LayerRule::fixed, quadrature::LayerRule::desingularised})
    for (const auto kernel : {CrossLayer::Kernel::single_layer, CrossLayer::Kernel::double_layer}) {
      s.options.rule = rule;
      CrossLayer layer(s.space, s.options, kernel);
      layer.set_shape(s.x);
      Net u(4, 3);
      layer.apply(s.f, s.at, s.all, u);
      Rows<double> rows;
      layer.assemble(s.at, s.all, rows);
      const Eigen::VectorXd product = rows * Eigen::Map<const Eigen::VectorXd>(s.f.data(), s.f.size());
      EXPECT_LT((Eigen::Map<const Net>(product.data(), 4, 3) - u).norm(), 1e-13) << deck::word(quadrature::layer_rules, rule);
    }
}

TEST(CrossLayer, KeepsItsNearRulesForFurtherDensities) {
  const Fixture s;
  for (const auto kernel : {CrossLayer::Kernel::single_layer, CrossLayer::Kernel::double_layer}) {
    CrossLayer layer(s.space, s.options, kernel);
    layer.set_shape(s.x);
    const CrossLayer::Near kept = layer.near(s.at, s.all);
    EXPECT_GT(kept.panels.size(), 0u);
    Net u(4, 3), again(4, 3);
    layer.apply(s.f, s.at, s.all, u);
    layer.apply(s.f, s.at, s.all, again, &kept);
    EXPECT_LT((u - again).norm(), 1e-13);
    if (kernel == CrossLayer::Kernel::single_layer) continue;
    const Net v0 = Vec3(1, -2, 3).transpose().replicate(4, 1);
    layer.apply(s.f, v0, s.at, s.all, u);
    layer.apply(s.f, v0, s.at, s.all, again, &kept);
    EXPECT_LT((u - again).norm(), 1e-13);
  }
}

TEST(CrossLayer, VanishesOutsideForAConstantVelocity) {
  const Fixture s;
  CrossLayer layer(s.space, s.options, CrossLayer::Kernel::double_layer);
  layer.set_shape(s.x);
  Net u(4, 3), shifted(4, 3);
  const Net v0 = Vec3(1, -2, 3).transpose().replicate(4, 1);
  layer.apply(s.f, s.at, s.all, u);
  layer.apply(s.f, v0, s.at, s.all, shifted);
  EXPECT_LT((u - shifted).norm(), 1e-7);
}

TEST(CrossLayer, MeasuresALoadOnTheUnstressedArea) {
  const Fixture s;
  CrossLayer layer(s.space, s.options, CrossLayer::Kernel::single_layer);
  layer.set_reference(2 * s.x);
  Net present(4, 3), reference(4, 3);
  layer.set_shape(s.x);
  layer.apply(s.f, s.at, s.all, present);
  layer.set_shape(s.x, Measure::reference);
  layer.apply(s.f, s.at, s.all, reference);
  EXPECT_LT((reference - 4 * present).norm() / present.norm(), 1e-7);
}

TEST(CrossLayer, MomentsAreDualToValues) {
  const Fixture s;
  CrossLayer layer(s.space, s.options, CrossLayer::Kernel::single_layer);
  layer.set_shape(s.x);
  std::vector<double> value[3];
  layer.values(s.f, value);
  const double sum = std::inner_product(value[0].begin(), value[0].end(), layer.weights().begin(), 0.);
  EXPECT_NEAR(layer.moments(layer.weights()).dot(s.f.col(0)) / sum, 1, 1e-13);
  EXPECT_NEAR(layer.moments(layer.weights()).sum() / surface::measures(s.space, s.x).area, 1, 1e-6);
}

}  // namespace
}  // namespace tanktread::stokes
