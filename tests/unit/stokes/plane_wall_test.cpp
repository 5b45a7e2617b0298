// Tests of layers in front of a plane wall.

#include <gtest/gtest.h>

#include <numeric>
#include <stdexcept>
#include <string>

#include <Eigen/Geometry>

#include "quadrature/gauss.hpp"
#include "spline/extraction.hpp"
#include "spline/space.hpp"
#include "stokes/kernels/image_kernel.hpp"
#include "stokes/medium/image_sum.hpp"
#include "surface/shapes.hpp"
#include "tests/layers.hpp"

namespace tanktread::stokes {
namespace plane_wall_test {

const PlaneWall level(Vec3(0.3, 0.2, -0.4), Vec3(0, 0, 1)), oblique(Vec3(0.1, -0.2, 0.3), Vec3(1, -2, 2));

/// Returns the velocity at x0 due to the images of one node at y with the strengths `strengths`.
Vec3 image(ImageSum::Kind kind, const PlaneWall& wall, const std::vector<double>& strengths, const Vec3& y, const Vec3& x0) {
  ImageSum sum(kind, wall, {});
  const std::vector<double> node[3] = {{y[0]}, {y[1]}, {y[2]}};
  sum.set_sources(node);
  sum.want({x0}, {0});
  std::vector<std::vector<double>> each;
  for (const double q : strengths) each.push_back({q});
  return sum.sum(each).row(0).transpose();
}

/// Returns G of (2.35).
Mat3 green(const PlaneWall& wall, const Vec3& y, const Vec3& x0) {
  Mat3 g = stokeslet(y - x0);
  for (int j = 0; j < 3; ++j) g.col(j) += image(ImageSum::Kind::forces, wall, {j == 0 ? 1. : 0., j == 1 ? 1. : 0., j == 2 ? 1. : 0.}, y, x0);
  return g;
}

/// Returns T S of (2.36).
Vec3 stress(const PlaneWall& wall, const Mat3& s, const Vec3& y, const Vec3& x0) {
  const Vec3 r = y - x0;
  return -6 * r * r.dot(s * r) / std::pow(r.norm(), 5) +
         image(ImageSum::Kind::stresslets, wall, {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(0, 2), s(1, 2)}, y, x0);
}

const Mat3 symmetric = (Mat3() << 0.3, 0.7, -0.2, 0.7, -0.5, 0.4, -0.2, 0.4, 0.9).finished();

Vec3 above(const PlaneWall& wall, double a, double b, double height) { return wall.point() + wall.axes().transpose() * Vec3(a, b, height); }

TEST(PlaneWall, KernelsVanishOnIt) {
  for (const PlaneWall& wall : {level, oblique})
    for (const double height : {0.01, 1.}) {
      const Vec3 y = above(wall, 0.2, -0.3, height), x0 = above(wall, 0.3, -0.1, 0);
      EXPECT_LT(green(wall, y, x0).norm(), 1e-13);
      EXPECT_LT(green(wall, x0, y).norm(), 1e-13);
      EXPECT_LT(stress(wall, symmetric, y, x0).norm(), 1e-11);
    }
}

TEST(PlaneWall, KernelIsSymmetric) {
  for (const PlaneWall& wall : {level, oblique}) {
    const Vec3 y = above(wall, 0.2, -0.3, 0.7), x0 = above(wall, -0.6, 0.1, 0.2);
    EXPECT_LT((green(wall, y, x0) - green(wall, x0, y).transpose()).norm(), 1e-14);
  }
}

/// Returns the velocity gradient by finite differences of fourth order.
Mat3 gradient(const auto& velocity, const Vec3& x) {
  constexpr double e = 1e-2;
  Mat3 l;
  for (int k = 0; k < 3; ++k) {
    const Vec3 d = e * Vec3::Unit(k);
    l.col(k) = (8 * (velocity(x + d) - velocity(x - d)) - (velocity(x + 2 * d) - velocity(x - 2 * d))) / (12 * e);
  }
  return l;
}

TEST(PlaneWall, FlowsAreFreeOfDivergence) {
  const Vec3 y = above(oblique, 0.2, -0.3, 0.7), x0 = above(oblique, -0.6, 0.1, 0.5);
  for (int j = 0; j < 3; ++j) EXPECT_LT(std::abs(gradient([&](const Vec3& x) { return Vec3(green(oblique, y, x).col(j)); }, x0).trace()), 1e-7);
  EXPECT_LT(std::abs(gradient([&](const Vec3& x) { return stress(oblique, symmetric, y, x); }, x0).trace()), 1e-6);
}

/// T S at x0 equals S times the stress at y in the flow of a point force at x0. The pressure of this flow does not contribute if S is trace-free.
TEST(PlaneWall, StressIsThatOfTheKernel) {
  const Vec3 y = above(oblique, 0.2, -0.3, 0.7), x0 = above(oblique, -0.6, 0.1, 0.5);
  const Mat3 s = symmetric - symmetric.trace() / 3 * Mat3::Identity();
  for (int i = 0; i < 3; ++i) {
    const Mat3 l = gradient([&](const Vec3& x) { return Vec3(green(oblique, x0, x).col(i)); }, y);
    EXPECT_NEAR(stress(oblique, s, y, x0)[i], (l + l.transpose()).cwiseProduct(s).sum(), 1e-6);
  }
}

/// If a point force is parallel to the wall, the force of the fluid on the wall equals this force. The integral of the velocity gradient over the
/// wall is therefore 8 pi times the force.
TEST(PlaneWall, BalancesAForceParallelToIt) {
  const Vec3 y = above(level, 0, 0, 0.5);
  constexpr double e = 1e-4;
  Mat3 pull = Mat3::Zero();
  const auto& gauss = quadrature::gauss(60);
  for (int k = 0; k < 60; ++k) {
    const double s = gauss.nodes[k], radius = s / (1 - s), weight = gauss.weights[k] / ((1 - s) * (1 - s));
    for (int a = 0; a < 16; ++a) {
      const double angle = a * M_PI / 8;
      const Mat3 slope = green(level, y, above(level, radius * std::cos(angle), radius * std::sin(angle), e)) / e;
      pull += weight * radius * M_PI / 8 * slope;
    }
  }
  EXPECT_NEAR(pull(0, 0), 8 * M_PI, 2e-2);
  EXPECT_NEAR(pull(1, 1), 8 * M_PI, 2e-2);
}

/// An ellipsoid in front of a wall, and a field on it.
struct Surface {
  spline::Space space;
  Net x, field;
  std::vector<int> all;
  double lowest;

  Surface() {
    const spline::TMesh mesh = spline::cube(6);
    space = spline::space(mesh, spline::ExtraordinaryRule::g1);
    const surface::LeastSquaresFit fit(space);
    const Net sphere = surface::unit_sphere(mesh, fit);
    x = fit.fit_image(sphere, [](const Vec3& p) { return Vec3(1.1 * p[0] + 0.2 * p[2], 0.9 * p[1], 0.8 * p[2]); });
    field = fit.fit_image(sphere, [](const Vec3& p) { return Vec3(p[1] - 0.3, p[2] * p[0], p[0] * p[0]); });
    all.resize(static_cast<std::size_t>(space.n_points));
    std::iota(all.begin(), all.end(), 0);
  }

  /// Returns the wall at this distance below the ellipsoid.
  PlaneWall below(double gap) const { return {Vec3(0, 0, -0.8 - gap), Vec3(0, 0, 1)}; }
};

const Surface& ellipsoid() {
  static const Surface one;
  return one;
}

Net layer_of(Layer::Kernel kernel, const Net& x, const Net& f, const PlaneWall& wall, double tolerance, const std::string& far_sum = "auto") {
  const Surface& of = ellipsoid();
  Layer layer(kernel, of.space, of.space.collocation, {.tolerance = tolerance, .far_sum = far_sum});
  layer.set_medium(wall);
  layer.set_shape(x);
  Net u = Net::Zero(of.space.n_points, 3);
  layer.apply(f, of.all, u);
  return u;
}

constexpr auto single = Layer::Kernel::single_layer, twofold = Layer::Kernel::double_layer;

double difference(const Net& a, const Net& b) { return (a - b).rowwise().norm().maxCoeff() / b.rowwise().norm().maxCoeff(); }

TEST(PlaneWall, DoubleLayersOfRigidMotionsVanish) {
  const Surface& of = ellipsoid();
  Net rotation(of.space.n_points, 3);
  for (int i = 0; i < of.space.n_points; ++i) rotation.row(i) = Vec3(1, 2, -1).cross(Vec3(of.x.row(i).transpose() - Vec3(3, 1, 2))).transpose();
  for (const double gap : {1., 0.1, 0.01, 0.003})
    for (const double tolerance : {1e-4, 1e-6, 1e-8})
      EXPECT_LT(layer_of(twofold, of.x, rotation, of.below(gap), tolerance).cwiseAbs().maxCoeff(), tolerance) << gap;
}

TEST(PlaneWall, LayersKeepTheTolerance) {
  const Surface& of = ellipsoid();
  for (const auto kernel : {single, twofold})
    for (const double gap : {1., 0.1, 0.01, 0.003}) {
      const Net exact = layer_of(kernel, of.x, of.field, of.below(gap), 1e-11);
      for (const double tolerance : {1e-4, 1e-6, 1e-8})
        EXPECT_LT(difference(layer_of(kernel, of.x, of.field, of.below(gap), tolerance), exact), tolerance) << gap << " " << int(kernel);
    }
}

TEST(PlaneWall, ClustersGiveTheSameSums) {
  const Surface& of = ellipsoid();
  for (const auto kernel : {single, twofold})
    for (const double gap : {1., 0.01})
      for (const double tolerance : {1e-4, 1e-6})
        EXPECT_LT(difference(layer_of(kernel, of.x, of.field, of.below(gap), tolerance, "tree"),
                             layer_of(kernel, of.x, of.field, of.below(gap), tolerance, "dense")),
                  tolerance)
            << gap << " " << int(kernel);
}

TEST(PlaneWall, ResultsDoNotDependOnItsDirection) {
  const Surface& of = ellipsoid();
  const Mat3 turn = Eigen::AngleAxisd(1.1, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  const PlaneWall wall = of.below(0.05), turned(turn * wall.point(), turn * wall.normal());
  for (const auto kernel : {single, twofold}) {
    const Net straight = layer_of(kernel, of.x, of.field, wall, 1e-6);
    EXPECT_LT(difference(layer_of(kernel, of.x * turn.transpose(), of.field * turn.transpose(), turned, 1e-6) * turn, straight), 1e-6);
  }
}

TEST(PlaneWall, RowsGiveTheSameSums) {
  const Surface& of = ellipsoid();
  for (const auto kernel : {single, twofold}) {
    Layer layer(kernel, of.space, of.space.collocation, {.tolerance = 1e-7});
    layer.set_medium(of.below(0.02));
    layer.set_shape(of.x);
    Rows<double> rows;
    layer.assemble(of.all, rows);
    const Eigen::VectorXd product = rows * Eigen::Map<const Eigen::VectorXd>(of.field.data(), of.field.size());
    EXPECT_LT(difference(Eigen::Map<const Net>(product.data(), of.space.n_points, 3), layer_of(kernel, of.x, of.field, of.below(0.02), 1e-7)), 1e-7);
  }
}

TEST(PlaneWall, HasNoSlip) {
  const Surface& of = ellipsoid();
  const PlaneWall wall = of.below(0.003);
  Net at(7, 3);
  for (int k = 0; k < 7; ++k) at.row(k) = above(wall, 0.15 * k - 0.4, 0.1 * k, 0).transpose();
  const std::vector<int> targets = {0, 1, 2, 3, 4, 5, 6};
  for (const auto kernel : {single, twofold}) {
    CrossLayer layer(of.space, {.tolerance = 1e-6}, kernel);
    layer.set_medium(wall);
    layer.set_shape(of.x);
    Net u = Net::Zero(7, 3);
    layer.apply(of.field, at, targets, u);
    EXPECT_LT(u.cwiseAbs().maxCoeff(), 1e-11);
  }
}

/// A medium that adds sums at all far rows and does not divide them among ranks: the velocity of the free-space kernel at displaced targets.
struct UndividedMedium : Medium {
  struct Sums : LayerMedium {
    void add(LayerSources& sources, const LayerTargets& targets, Net& u) override {
      std::vector<Vec3> at = rows_of(targets.at, targets.far_rows);
      for (Vec3& x : at) x[2] += 3;
      u(targets.far_rows, Eigen::all) += sources.direct_sum(sources.surface.node, at, rows_of(targets.f0, targets.far_rows));
    }
    bool add_row(LayerSources& /*sources*/, const Vec3& /*x0*/, std::vector<Mat3>& /*block*/) override { return false; }
  };
  std::unique_ptr<LayerMedium> in_layer(const LayerSources& /*sources*/, bool /*by_clusters*/) const override { return std::make_unique<Sums>(); }
  bool contains(const Vec3& /*x*/) const override { return true; }
  std::string refusal(const AmbientFlow& /*flow*/) const override { return {}; }
};

TEST(Medium, PartsOfTheSumsAddUp) {
  const Surface& of = ellipsoid();
  const PlaneWall wall = of.below(0.1);
  const UndividedMedium undivided;
  for (const auto kernel : {single, twofold})
    for (const Medium* medium : {static_cast<const Medium*>(&wall), static_cast<const Medium*>(&undivided)}) {
      const auto part_of = [&](int part, int parts) {
        Layer layer(kernel, of.space, of.space.collocation, {.far_sum = "tree"});
        layer.set_medium(*medium);
        layer.share(part, parts, of.all);
        layer.set_shape(of.x);
        std::vector<int> mine;
        for (int i = part; i < of.space.n_points; i += parts) mine.push_back(i);
        Net u = Net::Zero(of.space.n_points, 3);
        layer.apply(of.field, mine, u);
        return u;
      };
      EXPECT_LT(difference(part_of(0, 3) + part_of(1, 3) + part_of(2, 3), part_of(0, 1)), 1e-13);  // round-off
    }
}

TEST(Medium, NeedsNearSingularRules) {
  const Surface& of = ellipsoid();
  for (const auto rule : {quadrature::LayerRule::fixed, quadrature::LayerRule::desingularised}) {
    Layer layer(single, of.space, of.space.collocation, {.rule = rule});
    EXPECT_THROW(layer.set_medium(of.below(0.1)), std::logic_error);
  }
}

}  // namespace plane_wall_test
}  // namespace tanktread::stokes
