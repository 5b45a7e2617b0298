#include "surface/geometry.hpp"

#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "quadrature/gauss.hpp"
#include "surface/patch.hpp"
#include "surfaces.hpp"
#include "tests/shape_measures.hpp"

namespace tanktread::surface {
namespace {

using std::numbers::pi;

/// Computes the same integrals from their definitions, by a plain loop with twelve points per direction.
Measures reference(const spline::Space& space, const Net& net) {
  const quadrature::TensorRule& rule = quadrature::tensor_gauss(12);
  Measures result;
  Vec3 first = Vec3::Zero();
  Mat3 second = Mat3::Zero();
  for (std::size_t e = 0; e < space.elements.size(); ++e) {
    const ElementPoints element(space, net, static_cast<int>(e));
    for (int q = 0; q < rule.size(); ++q) {
      const Jet at = jet(element.patch(), rule.s[q], rule.t[q]);
      const Vec3 normal = rule.weights[q] * at.s.cross(at.t);
      result.area += normal.norm();
      const double flux = at.x.dot(normal);
      result.volume += flux / 3;
      first += flux / 4 * at.x;
      second += flux / 5 * at.x * at.x.transpose();
    }
  }
  result.centroid = first / result.volume;
  result.second_moments = second - result.volume * result.centroid * result.centroid.transpose();
  return result;
}

TEST(Geometry, VolumeAndMomentsAreExactForPolynomialElements) {
  const CubeMesh cube(3);
  const Net net = cube.crumpled(0.1);
  const Measures fast = measures(cube.space, net), exact = reference(cube.space, net);
  // Both rules are exact: only the order of sums of some thousand terms differs.
  EXPECT_NEAR(fast.volume, exact.volume, 1e-12);
  EXPECT_NEAR(volume(cube.space, net), exact.volume, 1e-12);
  EXPECT_LT((fast.centroid - exact.centroid).norm(), 1e-12);
  EXPECT_LT((fast.second_moments - exact.second_moments).norm(), 1e-12);
  // The area is not a polynomial; this coarse, crumpled surface shows the difference between eight and twelve points.
  EXPECT_NEAR(fast.area, exact.area, 1e-4);
}

TEST(Geometry, MeasuresOfAnEllipsoidHaveTheOrderOfItsFit) {
  const Vec3 axes(1.5, 1.0, 0.7), turn(30, 40, -50), place(2, -1, 3);
  double before = 1;
  for (const int n : {3, 6, 12}) {
    const CubeMesh cube(n);
    const Net net = cube.ellipsoid(axes, turn, place);
    const Measures m = measures(cube.space, net);
    const Eigen::SelfAdjointEigenSolver<Mat3> principal(m.second_moments);
    const Vec3 fitted = (5 / m.volume * principal.eigenvalues().reverse()).cwiseSqrt();  // (6.1)
    EXPECT_LT((m.centroid - place).norm(), 1e-12);  // by symmetry, for any fit
    const double error = std::abs(m.volume / (4 * pi / 3 * axes.prod()) - 1);
    const double error_axes = (fitted - axes).norm();
    EXPECT_LT(error, n == 3 ? 1e-5 : n == 6 ? 1e-6 : 1e-8);
    EXPECT_LT(error_axes, n == 3 ? 1e-5 : n == 6 ? 1e-6 : 1e-8);
    if (n == 12) {
      EXPECT_LT(error_axes, before / 16);  // at least fourth order; at n = 3 the error changes sign by chance
    }
    before = error_axes;
  }
}

TEST(Geometry, AreaOfASphereConverges) {
  double before = 1;
  for (const int n : {3, 6, 12}) {
    const CubeMesh cube(n);
    const double error = std::abs(measures(cube.space, cube.sphere()).area / (4 * pi) - 1);
    EXPECT_LT(error, before / 16);
    before = error;
  }
  EXPECT_LT(before, 1e-7);
}

TEST(Geometry, VolumeGradientIsTheDerivativeOfTheVolume) {
  const CubeMesh cube(3);
  const Geometry geometry(cube.space);
  const Net net = cube.crumpled(0.1);
  const Net b = geometry.volume_gradient(net);
  const double h = 1e-3;
  for (int a = 0; a < net.rows(); ++a) {
    for (int c = 0; c < 3; ++c) {
      Net moved = net;
      moved(a, c) += h;
      const double above = geometry.volume(moved);
      moved(a, c) -= 2 * h;
      // V is a cubic polynomial that is linear in each coordinate of one point, so central differences are exact up to round-off.
      EXPECT_NEAR(b(a, c), (above - geometry.volume(moved)) / (2 * h), 1e-11);
    }
  }
}

TEST(Geometry, VolumeGradientObeysTranslationAndScaling) {
  const CubeMesh cube(4);
  const Net net = cube.crumpled(0.1);
  const Net b = Geometry(cube.space).volume_gradient(net);
  EXPECT_LT(b.colwise().sum().norm(), 1e-13);                                  // closed surface: int n dGamma = 0
  EXPECT_NEAR(b.cwiseProduct(net).sum(), 3 * volume(cube.space, net), 1e-12);  // V is homogeneous of degree three
  Vec3 torque = Vec3::Zero();
  for (int a = 0; a < net.rows(); ++a) torque += Vec3(net.row(a)).cross(Vec3(b.row(a)));
  EXPECT_LT(torque.norm(), 1e-12);  // a rotation does not change the volume
}

TEST(Geometry, APartOfTheElementsGivesBitwiseEqualRows) {
  const CubeMesh cube(5);
  const Geometry geometry(cube.space);
  const Net net = cube.crumpled(0.05);
  const Net all = geometry.volume_gradient(net);
  for (const int first : {0, 40, 90}) {
    std::vector<bool> own(cube.space.n_points, false);
    for (int a = first; a < first + 30; ++a) own[a] = true;
    std::vector<int> elements;
    for (int e = 0; e < static_cast<int>(cube.space.elements.size()); ++e)
      for (const int a : cube.space.elements[e].points)
        if (own[a]) {
          elements.push_back(e);
          break;
        }
    Net part;
    geometry.volume_gradient(net, elements, part);
    for (int a = first; a < first + 30; ++a) EXPECT_EQ(part.row(a), all.row(a)) << "row " << a;
  }
}

TEST(Geometry, DistributedBlocksOfElementsGiveBitwiseEqualMeasures) {
  const CubeMesh cube(6);
  const Net net = cube.crumpled(0.05);
  const Geometry geometry(cube.space);
  const Measures whole = geometry.measures(net);
  ASSERT_GT(geometry.n_blocks(), 2);
  std::vector<double> moments(geometry.block_moments(net, {}).size(), 0.);
  for (int b = geometry.n_blocks(); b-- > 0;) {  // adding the zeros of other blocks changes nothing, in any order
    const std::vector<double> m = geometry.block_moments(net, std::span(&b, 1));
    for (std::size_t k = 0; k < m.size(); ++k) moments[k] += m[k];
  }
  const Measures shared = Geometry::measures(net, moments);
  EXPECT_EQ(shared.area, whole.area);
  EXPECT_EQ(shared.centroid, whole.centroid);
  EXPECT_EQ(shared.second_moments, whole.second_moments);
}

TEST(Geometry, FarFromTheOriginAccuracyIsKept) {
  const CubeMesh cube(4);
  Net net = cube.crumpled(0.05);
  const Geometry geometry(cube.space);
  const Measures here = geometry.measures(net);
  const Deformation shape = deformation(geometry, net);
  net.col(0).array() += 1e3;
  net.col(2).array() -= 1e3;
  // Coordinates of 1e3 have round-off of 1e-13.
  EXPECT_NEAR(geometry.volume(net), here.volume, 1e-11);
  EXPECT_LT((geometry.measures(net).second_moments - here.second_moments).norm(), 1e-11);
  EXPECT_NEAR(deformation(geometry, net).taylor_inertia, shape.taylor_inertia, 1e-11);
  EXPECT_NEAR(deformation(geometry, net).taylor_surface, shape.taylor_surface, 1e-11);
}

TEST(Geometry, NormalsPointOutwardEverywhere) {
  const CubeMesh cube(3);
  const Net net = cube.sphere();
  const quadrature::TensorRule& rule = quadrature::tensor_gauss(3);
  for (int e = 0; e < static_cast<int>(cube.space.elements.size()); ++e) {
    for (int q = 0; q < rule.size(); ++q) {
      const Point p = point(cube.space, net, {e, rule.s[q], rule.t[q]});
      EXPECT_GT(p.n.dot(p.x.normalized()), 0.99);
      EXPECT_NEAR(p.jacobian, p.a1.cross(p.a2).norm(), 1e-15);
      EXPECT_LT((value(cube.space, net, {e, rule.s[q], rule.t[q]}) - p.x).norm(), 1e-15);
    }
  }
}

/// Returns the root mean square error of the mean curvature on a sphere of radius 2 or on a spheroid, relative to the exact value.
double curvature_error(int n, bool spheroid) {
  const CubeMesh cube(n);
  const Vec3 axes = spheroid ? Vec3(1, 1, 1.5) : Vec3(2, 2, 2);
  const Net net = cube.ellipsoid(axes);
  const quadrature::TensorRule& rule = quadrature::tensor_gauss(3);
  double sum = 0, area = 0;
  for (int e = 0; e < static_cast<int>(cube.space.elements.size()); ++e) {
    for (int q = 0; q < rule.size(); ++q) {
      const spline::Site site{e, rule.s[q], rule.t[q]};
      const Point at = point(cube.space, net, site);
      const Vec3 g = at.x.cwiseQuotient(axes.cwiseAbs2()), inverse_squares = axes.cwiseAbs2().cwiseInverse();
      // 1/2 div(g/|g|) with g half the gradient of sum x_i^2/a_i^2
      const double exact = (inverse_squares.sum() - inverse_squares.dot(g.cwiseAbs2()) / g.squaredNorm()) / (2 * g.norm());
      const double weight = rule.weights[q] * at.jacobian;
      sum += weight * std::pow(mean_curvature(cube.space, net, site) / exact - 1, 2);
      area += weight;
    }
  }
  return std::sqrt(sum / area);
}

TEST(Geometry, MeanCurvatureOfSphereAndSpheroidConverges) {
  for (const bool spheroid : {false, true}) {
    const double coarse = curvature_error(6, spheroid), fine = curvature_error(12, spheroid), finest = curvature_error(24, spheroid);
    // First order overall: around the extraordinary points, on a fraction h^2 of the surface, the curvature does not converge.
    EXPECT_GT(std::log2(coarse / fine), 0.9);
    EXPECT_GT(std::log2(fine / finest), 0.9);
    EXPECT_LT(finest, 5e-3);
  }
}

}  // namespace
}  // namespace tanktread::surface
