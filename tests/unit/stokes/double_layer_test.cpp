
#include <gtest/gtest.h>

#include <numeric>

#include "deck/section.hpp"
#include "spline/extraction.hpp"
#include "spline/space.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"
#include "tests/layers.hpp"

namespace tanktread::stokes {
namespace {

/// A deformed surface on the smallest cube mesh.
struct Scene {
  spline::Space space;
  Net x, v;
  std::vector<int> all;

  Scene() {
    const spline::TMesh mesh = spline::cube(3);
    space = spline::space(mesh, spline::ExtraordinaryRule::g1);
    const surface::LeastSquaresFit fit(space);
    const Net sphere = surface::unit_sphere(mesh, fit);
    x = fit.fit_image(sphere, [](const Vec3& p) { return Vec3(1.3 * p[0] + 0.4 * p[2], 0.9 * p[1] + 0.1 * p[0] * p[0], 0.75 * p[2]); });
    v = fit.fit_image(sphere, [](const Vec3& p) { return Vec3(p[1] - 0.3, p[2] * p[0], p[0] * p[0]); });
    all.resize(space.n_points);
    std::iota(all.begin(), all.end(), 0);
  }

  Net apply(const Net& velocity, const quadrature::Options& options) const {
    DoubleLayer layer(space, options);
    Net u = Net::Zero(space.n_points, 3);
    layer.apply(x, velocity, all, u);
    return u;
  }
};

const Scene& scene() {
  static const Scene one;
  return one;
}

double largest(const Net& u) { return u.rowwise().norm().maxCoeff(); }

TEST(DoubleLayer, AssembledRowsTimesAVelocityAreTheSum) {
  using enum quadrature::LayerRule;
  for (const auto rule : {adaptive, fixed, desingularised}) {
    DoubleLayer layer(scene().space, {.tolerance = 1e-6, .rule = rule, .points = 4});
    Net u = Net::Zero(scene().space.n_points, 3), rows = u;
    layer.apply(scene().x, scene().v, scene().all, u);
    Rows<double> a;
    layer.assemble(scene().x, scene().all, a);
    rows.reshaped<Eigen::RowMajor>() = a * scene().v.reshaped<Eigen::RowMajor>();
    EXPECT_LT(largest(u - rows), 1e-12 * largest(u)) << deck::word(quadrature::layer_rules, rule);  // round-off of sums in another order
  }
}

// The integrand vanishes for a translation. For a rotation, int T_ijk n_k (omega x r)_j dGamma = 0 inside and on the surface (2.3).
TEST(DoubleLayer, VanishesForRigidBodyMotions) {
  Net translation = Net::Zero(scene().space.n_points, 3), rotation = translation;
  translation.rowwise() = Eigen::RowVector3d(1, -2, 3);
  for (int i = 0; i < scene().space.n_points; ++i) rotation.row(i) = Vec3(0.3, 0.9, -0.2).cross(Vec3(scene().x.row(i))).transpose();
  EXPECT_LT(largest(scene().apply(translation, {.tolerance = 1e-4})), 1e-13);
  EXPECT_LT(largest(scene().apply(rotation, {.tolerance = 1e-10})), 1e-10 * largest(rotation));
}

/// Two surfaces: the scene, and its reflection about a horizontal plane, at a gap above its top. Targets are on the second surface.
struct Film {
  spline::Space space;
  Net x;
  std::vector<int> all;

  explicit Film(double gap) {
    const spline::Space* const both[] = {&scene().space, &scene().space};
    space = spline::stacked(both);
    const int n = scene().space.n_points;
    const auto height = [](int i) -> double { return surface::value(scene().space, scene().x, scene().space.collocation[i].front())[2]; };
    int top = 0;
    for (const int i : scene().all)
      if (height(i) > height(top)) top = i;
    const Vec3 peak = surface::value(scene().space, scene().x, scene().space.collocation[top].front());
    x = Net(2 * n, 3);
    const Eigen::DiagonalMatrix<double, 3> over(1, -1, -1);
    x << scene().x, (scene().x * over).rowwise() + (peak - over * peak + gap * Vec3::UnitZ()).transpose();
    for (int i = n; i < 2 * n; ++i) all.push_back(i);
  }
};

// int T_ijk n_k (U + omega x r)_j dGamma = 0 outside (2.3), at any distance and for any velocity of the surface that contains the target.
TEST(DoubleLayer, VanishesAcrossAFilmForRigidBodyMotionsOfTheOtherSurface) {
  for (const double gap : {0.1, 1e-3}) {
    const Film film(gap);
    const int n = scene().space.n_points;
    Net v = Net::Zero(2 * n, 3), u = v;
    for (int i = 0; i < n; ++i) v.row(i) = (Vec3(0.5, 0.4, -0.6) + Vec3(0.1, 0.3, -0.2).cross(Vec3(film.x.row(i)))).transpose();
    for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
      DoubleLayer layer(film.space, {.tolerance = tolerance});
      layer.apply(film.x, v, film.all, u);
      EXPECT_LT(largest(u), 2 * tolerance) << gap;
    }
  }
}

TEST(DoubleLayer, AssembledRowsOfTwoSurfacesTimesAVelocityAreTheSum) {
  const Film film(0.01);
  DoubleLayer layer(film.space, {.tolerance = 1e-6});
  Net v = film.x, u = Net::Zero(film.space.n_points, 3);
  v.bottomRows(scene().space.n_points) = scene().v;
  layer.apply(film.x, v, film.all, u);
  Rows<double> a;
  layer.assemble(film.x, film.all, a);
  const Eigen::VectorXd rows = a * v.reshaped<Eigen::RowMajor>();
  EXPECT_LT((u.bottomRows(scene().space.n_points).reshaped<Eigen::RowMajor>() - rows).norm(),
            1e-11 * rows.norm());  // round-off, multiplied by 1 / gap^2
}

TEST(DoubleLayer, DesingularisedAgreesToTheOrderOfItsPoints) {
  const Net exact = scene().apply(scene().v, {.tolerance = 1e-10});
  const double at_6 = largest(scene().apply(scene().v, {.rule = quadrature::LayerRule::desingularised, .points = 6}) - exact) / largest(exact);
  const double at_12 = largest(scene().apply(scene().v, {.rule = quadrature::LayerRule::desingularised, .points = 12}) - exact) / largest(exact);
  EXPECT_LT(at_12, 1e-3);
  EXPECT_GT(at_6 / at_12, 3.5);  // the integrand is bounded but not smooth: the order is at least two in the spacing of the points
}

TEST(SingleLayer, DesingularisedAgreesToTheOrderOfItsPoints) {
  const auto apply = [](const quadrature::Options& options) {
    SingleLayer layer(scene().space, options);
    Net u = Net::Zero(scene().space.n_points, 3);
    layer.apply(scene().x, scene().v, Measure::current, scene().all, u);
    return u;
  };
  const Net exact = apply({.tolerance = 1e-10});
  const double at_6 = largest(apply({.rule = quadrature::LayerRule::desingularised, .points = 6}) - exact) / largest(exact);
  const double at_12 = largest(apply({.rule = quadrature::LayerRule::desingularised, .points = 12}) - exact) / largest(exact);
  EXPECT_LT(at_12, 1e-3);
  EXPECT_GT(at_6 / at_12, 3.5);  // the order is at least two, as for the double layer
}

}  // namespace
}  // namespace tanktread::stokes
