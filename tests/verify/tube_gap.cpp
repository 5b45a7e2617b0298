// Sphere almost as wide as the tube: integrals across the gap keep the requested tolerance.

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "surface/geometry.hpp"
#include "system/targets/collocation.hpp"
#include "tests/layers.hpp"
#include "tests/verify/tube_scene.hpp"

namespace tanktread {
namespace tube_gap_test {

using stokes::CrossLayer;

Net field(const Net& x, const Vec3& wave) {
  Net f(x.rows(), 3);
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const double phase = wave.dot(Vec3(x.row(i)));
    f.row(i) << 1 + std::sin(phase), std::cos(phase), x(i, 1) * std::cos(2 * phase);
  }
  return f;
}

Net layer(const spline::Space& space, const Net& x, CrossLayer::Kernel kernel, double tolerance, const Net& f, const Net& at) {
  quadrature::Options options;
  options.tolerance = tolerance;
  CrossLayer layer(space, options, kernel);
  layer.set_shape(x);
  std::vector<int> all(static_cast<std::size_t>(at.rows()));
  std::iota(all.begin(), all.end(), 0);
  Net u(at.rows(), 3);
  layer.apply(f, at, all, u);
  return u;
}

/// Returns the largest error at this tolerance, divided by the largest value.
double error(const spline::Space& space, const Net& x, CrossLayer::Kernel kernel, double tolerance, const Net& f, const Net& at) {
  const Net u = layer(space, x, kernel, tolerance, f, at), exact = layer(space, x, kernel, 1e-12, f, at);
  return (u - exact).rowwise().norm().maxCoeff() / exact.rowwise().norm().maxCoeff();
}

TEST(TubeGap, LayersKeepTheirToleranceAcrossIt) {
  const surface::TubeWall wall = circular_duct(21, 17).wall;
  Net rings(wall.net.rows(), 3);
  for (int i = 0; i < wall.space.n_points; ++i)
    rings.row(i) = surface::value(wall.space, wall.net, wall.space.collocation[static_cast<std::size_t>(i)].front()).transpose();
  for (const double gap : {0.2, 0.02}) {  // gap divided by R_C
    const Sphere inside = sphere(1 / (1 + gap), Vec3::Zero(), 6);
    const Net sites = coupling::collocation_matrix(inside.space) * inside.net;
    const Net load = field(inside.net, Vec3(3, 1, -2)), traction = field(wall.net, Vec3(2, -1, 1));
    for (const double tolerance : {1e-5, 1e-6}) {
      EXPECT_LT(error(inside.space, inside.net, CrossLayer::Kernel::single_layer, tolerance, load, rings), tolerance) << gap;
      EXPECT_LT(error(wall.space, wall.net, CrossLayer::Kernel::single_layer, tolerance, traction, sites), tolerance) << gap;
      EXPECT_LT(error(inside.space, inside.net, CrossLayer::Kernel::double_layer, tolerance, load, rings), 2 * tolerance) << gap;
    }
  }
}

}  // namespace tube_gap_test
}  // namespace tanktread
