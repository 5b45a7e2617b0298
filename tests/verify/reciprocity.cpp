// Lorentz' reciprocal theorem for two separate surfaces: the work of the single layer of one on the density of the other is the same in both
// directions.

#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "quadrature/gauss.hpp"
#include "spline/extraction.hpp"
#include "spline/t_mesh.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"
#include "tests/layers.hpp"

namespace tanktread::stokes {
namespace {

/// Deformed surface with a smooth density on it.
struct Body {
  spline::Space space;
  Net x, density;

  explicit Body(int n, const Vec3& centre, double bend) {
    const spline::TMesh mesh = spline::cube(n);
    space = spline::space(mesh, spline::ExtraordinaryRule::g1);
    x = surface::resting_shape(space, mesh, {});
    density = Net(x.rows(), 3);
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      const Vec3 p = x.row(i).transpose();
      x.row(i) << centre[0] + 1.4 * p[0] + 0.2 * p[2], centre[1] + 0.8 * p[1] + bend * p[0] * p[0], centre[2] + 0.9 * p[2] - bend * p[0] * p[1];
      density.row(i) << std::sin(p[0] + centre[0]) + p[1], p[2] * p[0], std::cos(p[2]) - centre[1] * p[1];
    }
  }
};

/// Returns int g.(S f) dGamma over `on`, where f is the density on `from`, by Gauss quadrature with `order` points per direction.
double work(const Body& on, const Body& from, int order) {
  const quadrature::TensorRule& rule = quadrature::tensor_gauss(order);
  std::vector<Vec3> places, strengths;
  for (int e = 0; e < static_cast<int>(on.space.elements.size()); ++e)
    for (int q = 0; q < rule.size(); ++q) {
      const spline::Site site{e, rule.s[q], rule.t[q]};
      const surface::Point p = surface::point(on.space, on.x, site);
      places.push_back(p.x);
      strengths.push_back(rule.weights[q] * p.jacobian * surface::value(on.space, on.density, site));
    }
  CrossLayer layer(from.space, {.tolerance = 1e-12}, CrossLayer::Kernel::single_layer);
  layer.set_shape(from.x);
  const auto n = static_cast<Eigen::Index>(places.size());
  const Net at = Eigen::Map<const Net>(places.front().data(), n, 3);
  std::vector<int> all(places.size());
  std::iota(all.begin(), all.end(), 0);
  Net u(n, 3);
  layer.apply(from.density, at, all, u);
  return u.cwiseProduct(Eigen::Map<const Net>(strengths.front().data(), n, 3)).sum();
}

TEST(Reciprocity, SingleLayersOfTwoDeformedSurfacesHaveEqualMutualWork) {
  const Body one(3, {0, 0, 0}, 0.2), other(4, {0.5, 3.2, -0.4}, -0.15);
  const double there = work(other, one, 12), back = work(one, other, 12);
  EXPECT_GT(std::abs(there), 0.1);
  EXPECT_NEAR(there, back, 1e-10 * std::abs(there));  // layers have the tolerance 1e-12, the outer Gauss rule 12 points
}

}  // namespace
}  // namespace tanktread::stokes
