
#include <gtest/gtest.h>

#include <numeric>

#include <Eigen/Geometry>

#include "deck/section.hpp"
#include "spline/extraction.hpp"
#include "spline/space.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"
#include "tests/layers.hpp"

namespace tanktread::stokes {
namespace single_layer_test {

/// A deformed surface on the smallest cube mesh, and a load on it.
struct Scene {
  spline::Space space;
  Net unstressed, x, f;
  std::vector<int> all;

  Scene() {
    const spline::TMesh mesh = spline::cube(3);
    space = spline::space(mesh, spline::ExtraordinaryRule::g1);
    const surface::LeastSquaresFit fit(space);
    unstressed = surface::unit_sphere(mesh, fit);
    x = fit.fit_image(unstressed, [](const Vec3& p) { return Vec3(1.3 * p[0] + 0.4 * p[2], 0.9 * p[1] + 0.1 * p[0] * p[0], 0.75 * p[2]); });
    f = fit.fit_image(unstressed, [](const Vec3& p) { return Vec3(p[1] - 0.3, p[2] * p[0], p[0] * p[0]); });
    all.resize(space.n_points);
    std::iota(all.begin(), all.end(), 0);
  }

  Net apply(const Net& at, const Net& load, const quadrature::Options& options, Measure measure = Measure::current) const {
    SingleLayer layer(space, options);
    layer.set_reference(unstressed);
    Net u = Net::Zero(space.n_points, 3);
    layer.apply(at, load, measure, all, u);
    return u;
  }
};

const Scene& scene() {
  static const Scene one;
  return one;
}

double largest(const Net& u) { return u.rowwise().norm().maxCoeff(); }

/// The choice of near panels and of their rules depends on the size of their own surface only: eight surfaces are integrated as accurately as one.
TEST(SingleLayer, RulesOfASurfaceDoNotDependOnHowManyThereAre) {
  const Scene one;
  std::vector<const spline::Space*> spaces(8, &one.space);
  const spline::Space space = spline::stacked(spaces);
  Net x(space.n_points, 3), f(space.n_points, 3);
  for (const spline::Block& block : spline::blocks(spaces)) {
    block.rows(x) = one.x.rowwise() + Eigen::RowVector3d(0, 0, 0.1 * block.first_point);
    block.rows(f) = one.f;
  }
  quadrature::Options options;
  options.tolerance = 1e-5;
  SingleLayer alone(one.space, options), among(space, options);
  Net u(one.space.n_points, 3), v(space.n_points, 3);
  alone.apply(one.x, one.f, Measure::current, one.all, u);
  among.apply(x, f, Measure::current, one.all, v);
  EXPECT_EQ(among.evaluations().near, alone.evaluations().near);
  EXPECT_EQ(among.evaluations().self, alone.evaluations().self);
}

TEST(SingleLayer, AssembledRowsTimesADensityAreTheSum) {
  using enum quadrature::LayerRule;
  for (const auto rule : {adaptive, fixed, desingularised}) {
    for (const Measure measure : {Measure::reference, Measure::current}) {
      SingleLayer layer(scene().space, {.tolerance = 1e-6, .rule = rule, .points = 4});
      layer.set_reference(scene().unstressed);
      Net u = Net::Zero(scene().space.n_points, 3), rows = u;
      layer.apply(scene().x, scene().f, measure, scene().all, u);
      Rows<double> a;
      layer.assemble(scene().x, measure, scene().all, a);
      rows.reshaped<Eigen::RowMajor>() = a * scene().f.reshaped<Eigen::RowMajor>();
      EXPECT_LT(largest(u - rows), 1e-12 * largest(u)) << deck::word(quadrature::layer_rules, rule);  // round-off of sums in another order
      Rows<float> single;
      layer.assemble(scene().x, measure, scene().all, single);
      EXPECT_LT((single.cast<double>() - a).cwiseAbs().maxCoeff(), 1e-5 * a.cwiseAbs().maxCoeff())
          << deck::word(quadrature::layer_rules, rule);  // single precision
    }
  }
}

TEST(SingleLayer, BlocksOfNearControlPointsAreThoseOfTheRows) {
  using enum quadrature::LayerRule;
  for (const auto rule : {adaptive, fixed, desingularised}) {
    SingleLayer layer(scene().space, {.tolerance = 1e-6, .rule = rule, .points = 4});
    layer.set_reference(scene().unstressed);
    Rows<double> a;
    layer.assemble(scene().x, Measure::reference, scene().all, a);
    NearPoints near;
    for (const int i : scene().all) {  // a few control points, including the target
      for (int j = i; j < scene().space.n_points; j += 17) near.point.push_back(j);
      near.first.push_back(near.point.size());
    }
    std::vector<double> entries;
    layer.assemble(scene().x, Measure::reference, scene().all, near, entries);
    ASSERT_EQ(entries.size(), 6 * near.point.size());
    const double allowed = 1e-13 * a.cwiseAbs().maxCoeff();  // round-off of sums over other panels
    for (const int i : scene().all)
      for (std::size_t j = near.first[i]; j < near.first[i + 1]; ++j) {
        const Mat3 block = a.block<3, 3>(3 * i, 3 * near.point[j]);
        const double upper[6] = {block(0, 0), block(0, 1), block(0, 2), block(1, 1), block(1, 2), block(2, 2)};
        for (std::size_t c = 0; c < 6; ++c) EXPECT_NEAR(entries[6 * j + c], upper[c], allowed) << deck::word(quadrature::layer_rules, rule);
      }
  }
}

TEST(SingleLayer, DoesNotDependOnHowTargetsAreSplit) {
  SingleLayer layer(scene().space, {.tolerance = 1e-6});
  layer.set_reference(scene().unstressed);
  Net whole = Net::Zero(scene().space.n_points, 3), parts = whole;
  layer.apply(scene().x, scene().f, Measure::reference, scene().all, whole);
  std::vector<int> odd, even;
  for (const int i : scene().all) (i % 2 ? odd : even).push_back(i);
  layer.apply(scene().x, scene().f, Measure::reference, odd, parts);
  layer.apply(scene().x, scene().f, Measure::reference, even, parts);
  EXPECT_EQ(whole, parts);  // bitwise equal
}

TEST(SingleLayer, ForgetsEarlierShapes) {
  SingleLayer used(scene().space, {.tolerance = 1e-6}), fresh(scene().space, {.tolerance = 1e-6});
  used.set_reference(scene().unstressed), fresh.set_reference(scene().unstressed);
  Net u = Net::Zero(scene().space.n_points, 3), v = u;
  for (const Net& x : {scene().unstressed, Net(2 * scene().x), scene().x}) used.apply(x, scene().f, Measure::reference, scene().all, u);
  fresh.apply(scene().x, scene().f, Measure::reference, scene().all, v);
  EXPECT_EQ(u, v);  // a resumed run must be bitwise equal
}

TEST(SingleLayer, MovesAndTurnsWithTheSurface) {
  const Mat3 turn = Eigen::AngleAxisd(0.9, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const Net u = scene().apply(scene().x, scene().f, {.tolerance = 1e-10});
  const Net moved = scene().apply((scene().x * turn.transpose()).rowwise() + Eigen::RowVector3d(5, -3, 2), scene().f * turn.transpose(),
                                  {.tolerance = 1e-10});
  EXPECT_LT(largest(moved - u * turn.transpose()), 1e-9 * largest(u));  // rules are chosen for other metrics and distances
}

TEST(SingleLayer, ScalesWithLengthAndWithTheDensity) {
  const Net u = scene().apply(scene().x, scene().f, {.tolerance = 1e-6}),
            v = scene().apply(4 * scene().x, 0.5 * scene().f, {.tolerance = 1e-6});
  EXPECT_LT(largest(v - 2 * u), 1e-13 * largest(u));  // equal rules, scaled by powers of two
}

TEST(SingleLayer, MeasuresAgreeWhereTheSurfaceIsUnstressed) {
  const Net u = scene().apply(scene().unstressed, scene().f, {.tolerance = 1e-6}, Measure::current);
  EXPECT_LT(largest(scene().apply(scene().unstressed, scene().f, {.tolerance = 1e-6}, Measure::reference) - u), 1e-13 * largest(u));
}

TEST(SingleLayer, KeepsItsToleranceAtTipsThatAreAsSharpAsTheirElements) {
  const spline::TMesh mesh = spline::cube(6);
  const spline::Space space = spline::space(mesh, spline::ExtraordinaryRule::g1);
  surface::ParticleShape spheroid;
  spheroid.shape = "spheroid", spheroid.semi_axes = Vec3(0.3, 0.3, 3);
  const Net x = surface::resting_shape(space, mesh, spheroid);
  std::vector<int> all(space.n_points);
  std::iota(all.begin(), all.end(), 0);
  Net u = Net::Zero(space.n_points, 3), exact = u;
  SingleLayer(space, {.tolerance = 1e-8}).apply(x, x, Measure::current, all, u);
  SingleLayer(space, {.tolerance = 1e-12}).apply(x, x, Measure::current, all, exact);
  EXPECT_LT(largest(u - exact), 2e-8 * largest(exact));  // twice the tolerance
}

TEST(SingleLayer, FixedRuleOfThePaperIsGoodToSevenDigitsAtVertices) {
  const Net exact = scene().apply(scene().x, scene().f, {.tolerance = 1e-10});
  const Net fixed = scene().apply(scene().x, scene().f, {.rule = quadrature::LayerRule::fixed, .points = 8});
  EXPECT_LT(largest(fixed - exact), 1e-6 * largest(exact));
  EXPECT_GT(largest(fixed - exact), 1e-9 * largest(exact));  // the rules differ
}

}  // namespace single_layer_test
}  // namespace tanktread::stokes
