// Tests of the layers of surfaces that repeat on a lattice.

#include <gtest/gtest.h>

#include <numeric>
#include <string>

#include <Eigen/Geometry>

#include "quadrature/gauss.hpp"
#include "spline/extraction.hpp"
#include "spline/space.hpp"
#include "surface/shapes.hpp"
#include "tests/layers.hpp"

namespace tanktread::stokes {
namespace {

/// An ellipsoid that nearly fills the cell, and a field on it.
struct Surface {
  spline::Space space;
  Net x, field;
  std::vector<int> all;

  Surface() {
    const spline::TMesh mesh = spline::cube(4);
    space = spline::space(mesh, spline::ExtraordinaryRule::g1);
    const surface::LeastSquaresFit fit(space);
    const Net sphere = surface::unit_sphere(mesh, fit);
    x = fit.fit_image(sphere, [](const Vec3& p) { return Vec3(0.4 * p[0] + 0.1 * p[2], 0.35 * p[1], 0.3 * p[2]); });
    field = fit.fit_image(sphere, [](const Vec3& p) { return Vec3(p[1] - 0.3, p[2] * p[0], p[0] * p[0]); });
    all.resize(static_cast<std::size_t>(space.n_points));
    std::iota(all.begin(), all.end(), 0);
  }
};

const Surface& ellipsoid() {
  static const Surface one;
  return one;
}

PeriodicCell cell(int n = 3, double tilt = 0.3) {
  Mat3 vectors = Mat3::Identity();
  vectors(0, 2) = tilt;
  return {vectors, n};
}

Net double_layer(const Net& x, const Net& v, const PeriodicCell& cell, double tolerance, const std::string& far_sum = "auto") {
  const auto& [space, own, field, all] = ellipsoid();
  DoubleLayer layer(space, {.tolerance = tolerance, .far_sum = far_sum});
  layer.repeat(cell);
  Net u = Net::Zero(space.n_points, 3);
  layer.apply(x, v, all, u);
  return u;
}

Net single_layer(const Net& x, const Net& f, const PeriodicCell& cell, double tolerance, const std::string& far_sum = "auto") {
  const auto& [space, own, field, all] = ellipsoid();
  SingleLayer layer(space, {.tolerance = tolerance, .far_sum = far_sum});
  layer.repeat(cell);
  Net u = Net::Zero(space.n_points, 3);
  layer.apply(x, f, Measure::current, all, u);
  return u;
}

double difference(const Net& a, const Net& b) { return (a - b).rowwise().norm().maxCoeff() / b.rowwise().norm().maxCoeff(); }

TEST(PeriodicLayer, DoubleLayersOfRigidMotionsVanish) {
  const auto& [space, x, field, all] = ellipsoid();
  for (const int n : {1, 2, 3})
    for (const double tolerance : {1e-4, 1e-6}) {
      Net rotation(space.n_points, 3);
      for (int i = 0; i < space.n_points; ++i) rotation.row(i) = Vec3(1, 2, -1).cross(Vec3(x.row(i).transpose() - Vec3(3, 1, 2))).transpose();
      EXPECT_LT(double_layer(x, rotation, cell(n), tolerance).cwiseAbs().maxCoeff(), tolerance) << n;
    }
}

TEST(PeriodicLayer, AssembledRowsOfTargetsAtFarNodesAreTheSum) {
  const auto& [space, x, field, every] = ellipsoid();
  constexpr int points = 3;
  Sites sites;
  const auto node = [&](int k) { return quadrature::gauss(points).nodes[k % points] * (1 + 1e-15); };  // up to rounding
  for (int e = 0; e < 16; ++e) sites.push_back({{e, node(e), node(e / 2)}});
  std::vector<int> all(sites.size());
  std::iota(all.begin(), all.end(), 0);
  Layer layer(Layer::Kernel::single_layer, space, sites, {.rule = quadrature::LayerRule::fixed, .points = points, .far_sum = "dense"});
  layer.repeat(cell(), {.assembled = true});
  layer.set_shape(x);
  Net u(static_cast<Eigen::Index>(sites.size()), 3);
  layer.apply(field, all, u);
  Rows<double> rows;
  layer.assemble(all, rows);
  const Eigen::VectorXd product = rows * Eigen::Map<const Eigen::VectorXd>(field.data(), field.size());
  EXPECT_LT((product - Eigen::Map<const Eigen::VectorXd>(u.data(), u.size())).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(PeriodicLayer, RowsDoNotDependOnTheNumberOfRowsAssembledTogether) {
  const auto& [space, x, field, all] = ellipsoid();
  for (const int n : {1, 2, 3}) {
    Layer layer(Layer::Kernel::single_layer, space, space.collocation, {.tolerance = 1e-6});
    layer.repeat(cell(n), {.assembled = true});
    layer.set_shape(x);
    Rows<double> few, many;
    layer.assemble(std::span(all).first(2), few);
    layer.assemble(std::span(all).first(20), many);
    EXPECT_LT((few - many.topRows(6)).cwiseAbs().maxCoeff(), 1e-13 * many.cwiseAbs().maxCoeff()) << n;
  }
}

TEST(PeriodicLayer, RowsOfImagesAreThoseOfTheSurfaceAtTwoPeriodsOnEitherSide) {
  const auto& [space, x, field, all] = ellipsoid();
  for (const Layer::Kernel kernel : {Layer::Kernel::single_layer, Layer::Kernel::double_layer}) {
    Layer layer(kernel, space, {}, {.tolerance = 1e-6}), images(kernel, space, {}, {.tolerance = 1e-6});
    images.repeat(cell(1), {.assembled = true});
    layer.set_shape(x), images.set_shape(x);
    Rows<float> rows;
    images.assemble_images(x, all, rows);  // at the control points; images are close to some of them
    const Net product = as_net(rows.cast<double>() * flat(field));
    Net sum = Net::Zero(x.rows(), 3);
    for (const double shift : {-2., -1., 1., 2.}) {
      Net u(x.rows(), 3);
      layer.apply(field, x.rowwise() - Eigen::RowVector3d(shift, 0, 0), all, u);
      sum += u;
    }
    EXPECT_LT(difference(product, sum), 1e-5);  // the tolerance, and rounding to single precision
  }
}

TEST(PeriodicLayer, SurfacesThatCrossTheFacesOfACellGiveTheSameResult) {
  const auto& [space, x, field, all] = ellipsoid();
  for (const int n : {1, 2, 3}) {
    const Net moved = x.rowwise() + Eigen::RowVector3d(0.47, n > 1 ? -0.41 : 0, n > 2 ? 0.3 : 0);
    for (const double tolerance : {1e-4, 1e-7}) {
      EXPECT_LT(difference(double_layer(moved, field, cell(n), tolerance), double_layer(x, field, cell(n), tolerance)), tolerance) << n;
      if (n < 3) continue;  // for a net force the velocity is determined only up to a constant
      EXPECT_LT(difference(single_layer(moved, field, cell(), tolerance), single_layer(x, field, cell(), tolerance)), tolerance);
    }
  }
}

TEST(PeriodicLayer, ClustersGiveTheSameSums) {
  const auto& [space, x, field, all] = ellipsoid();
  for (const double tolerance : {1e-3, 1e-5}) {
    EXPECT_LT(difference(double_layer(x, field, cell(), tolerance, "tree"), double_layer(x, field, cell(), tolerance, "dense")), tolerance);
    EXPECT_LT(difference(single_layer(x, field, cell(), tolerance, "tree"), single_layer(x, field, cell(), tolerance, "dense")), tolerance);
  }
}

TEST(PeriodicLayer, CellsWithOneAndTwoSurfacesGiveTheSameResult) {
  const auto& [space, x, field, all] = ellipsoid();
  const spline::Space two = spline::stacked(std::vector<const spline::Space*>{&space, &space});
  const PeriodicCell one = cell();
  Mat3 longer = one.vectors();
  const Vec3 h = longer.col(2);
  longer.col(2) *= 2;
  Net both(2 * space.n_points, 3), fields(2 * space.n_points, 3);
  both << x, x.rowwise() + h.transpose();
  fields << field, field;
  for (const double tolerance : {1e-4, 1e-7}) {
    SingleLayer single(two, {.tolerance = tolerance});
    DoubleLayer twice(two, {.tolerance = tolerance});
    single.repeat({longer, 3}), twice.repeat({longer, 3});
    Net u = Net::Zero(2 * space.n_points, 3), v = u;
    single.apply(both, fields, Measure::current, all, u);
    twice.apply(both, fields, all, v);
    EXPECT_LT(difference(u.topRows(space.n_points), single_layer(x, field, one, tolerance)), tolerance);
    EXPECT_LT(difference(v.topRows(space.n_points), double_layer(x, field, one, tolerance)), tolerance);
  }
}

TEST(PeriodicLayer, ACellTiltedByAWholePeriodGivesTheSameResult) {
  const auto& [space, x, field, all] = ellipsoid();
  EXPECT_LT(difference(single_layer(x, field, cell(3, 1), 1e-7), single_layer(x, field, cell(3, 0), 1e-7)), 1e-13);  // both have equal shortest
                                                                                                                     // lattice vectors
  for (const double tolerance : {1e-4, 1e-7}) {
    EXPECT_LT(difference(single_layer(x, field, cell(3, 0.51), tolerance), single_layer(x, field, cell(3, -0.49), tolerance)), 1e-12);
    EXPECT_LT(difference(double_layer(x, field, cell(3, 0.5), tolerance), double_layer(x, field, cell(3, -0.5), tolerance)), tolerance);
  }
}

}  // namespace
}  // namespace tanktread::stokes
