#include "surface/shapes.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "base/indices.hpp"
#include "quadrature/gauss.hpp"
#include "surface/geometry.hpp"
#include "surface/partition.hpp"
#include "surface/patch.hpp"
#include "tests/shape_measures.hpp"

namespace tanktread::surface {
namespace {

using spline::PoleRule;
const std::vector<PoleRule> every_rule = [] {
  std::vector<PoleRule> all;
  for (std::size_t k = 0; k < spline::pole_rules.size(); ++k) all.push_back(static_cast<PoleRule>(k));
  return all;
}();

/// Semi-axes of the paper's spheroid: V = 1, b/a = 1.5, poles on the long axis.
const Vec3 spheroid_axes(0.5419260701, 0.5419260701, 0.8128891052);

/// Returns the L2 norm over the surface of the error in the normal: image of the sphere under x -> axes * x compared with the ellipsoid.
double normal_error(const spline::PolarMesh& mesh, const Vec3& axes) {
  const spline::Space space = spline::space(mesh);
  const Net net = unit_sphere(mesh, space) * axes.asDiagonal();
  const quadrature::TensorRule& rule = quadrature::tensor_gauss(8);
  double sum = 0;
  for (std::size_t e = 0; e < space.elements.size(); ++e) {
    const ElementPoints element(space, net, static_cast<int>(e));
    for (int q = 0; q < rule.size(); ++q) {
      const Jet at = jet(element.patch(), rule.s[q], rule.t[q]);
      const Vec3 n = at.s.cross(at.t), exact = at.x.cwiseQuotient(axes.cwiseAbs2()).normalized();
      sum += rule.weights[q] * n.norm() * (n.normalized() - exact).squaredNorm();
    }
  }
  return std::sqrt(sum);
}

TEST(PolarSphere, NormalOfThePapersSpheroidIsBetterThanThePapers) {
  // 42, 146, 546 and 2114 points. A least-squares fit of positions gives 8.7e-3, 1.0e-3, 1.2e-4 and 1.5e-5. The paper's best result with 546 points
  // is 8.947e-5.
  const double table[] = {6.52e-3, 7.26e-4, 8.78e-5, 1.086e-5};
  for (const PoleRule rule : {PoleRule::plain, PoleRule::c1}) {
    double before = 0;
    for (int k = 0; k < 4; ++k) {
      const double error = normal_error({8 << k, 4 << k, rule}, spheroid_axes);
      EXPECT_LT(error, 1.02 * table[k]);
      EXPECT_GT(error, 0.95 * table[k]);
      if (k > 0) {
        EXPECT_GT(std::log2(before / error), 2.95);
      }
      before = error;
    }
  }
}

TEST(PolarSphere, ErrorOfTheTransformAtThePolesIsProportionalToTheAngleOfAPiece) {
  // On the unit sphere with 146 control points, the transform adds an error to the error of the plain mesh. Each subdivision halves the added error.
  const double plain = normal_error({16, 8, PoleRule::plain}, Vec3::Ones());
  double before = 0;
  for (int n = 0; n <= 4; ++n) {
    const double error = normal_error({16, 8, PoleRule::bezier_transform, n}, Vec3::Ones());
    const double added = std::sqrt(error * error - plain * plain);
    if (n > 1) {
      EXPECT_NEAR(before / added, 2, 0.2);
    }
    before = added;
  }
  EXPECT_LT(before, 0.3 * plain);
}

TEST(PolarSphere, HasTheNumberOfControlPointsOfTheOptions) {
  for (const PoleRule rule : every_rule)
    for (const auto& [m, r] : {std::array{4, 4}, {9, 5}, {16, 8}}) {
      MeshOptions options;
      options.mesh = "polar", options.azimuthal_elements = m, options.meridional_elements = r, options.poles = rule;
      const spline::PolarMesh mesh = options.polar_mesh();
      const spline::Space space = spline::space(mesh);
      EXPECT_EQ(options.n_points(), space.n_points);
      EXPECT_EQ(unit_sphere(mesh, space).rows(), space.n_points);
    }
}

TEST(PolarSphere, IsClosedWithOutwardNormals) {
  for (const PoleRule rule : every_rule) {
    const spline::PolarMesh mesh{16, 8, rule};
    const spline::Space space = spline::space(mesh);
    const Net net = unit_sphere(mesh, space);
    const double exact = 4 * std::numbers::pi / 3;
    EXPECT_NEAR(volume(space, net), exact, 5e-6 * exact);
    const Net flux = Geometry(space).volume_gradient(net);
    EXPECT_LT(flux.colwise().sum().norm(), 1e-13);                             // int n dGamma = 0
    EXPECT_NEAR(flux.cwiseProduct(net).sum(), 3 * volume(space, net), 1e-12);  // int x.n dGamma = 3 V
    for (std::size_t e = 0; e < space.elements.size(); ++e) {
      const Jet at = jet(ElementPoints(space, net, static_cast<int>(e)).patch(), 0.3, 0.6);
      EXPECT_GT(at.s.cross(at.t).normalized().dot(at.x), 0.98);
    }
  }
}

TEST(PolarSphere, HasItsPolesOnTheRequestedAxis) {
  for (const int axis : {0, 1, 2}) {
    const spline::PolarMesh mesh{8, 4, PoleRule::plain};
    const Net net = unit_sphere(mesh, spline::space(mesh), axis);
    EXPECT_LT((net.row(0).transpose() + Vec3::Unit(axis)).norm(), 1e-2);  // the error of the fit
    EXPECT_LT((net.row(net.rows() - 1).transpose() - Vec3::Unit(axis)).norm(), 1e-2);
  }
}

TEST(PolarSphere, ConvergesOnUnequalMeshes) {
  for (const auto& [m, r] : {std::array{4, 4}, {64, 8}, {12, 20}, {50, 50}}) {
    const spline::PolarMesh mesh{m, r, PoleRule::plain};
    const spline::Space space = spline::space(mesh);
    const double h = 2 * std::numbers::pi * std::max(1.0 / m, 0.5 / r);
    EXPECT_NEAR(volume(space, unit_sphere(mesh, space)) * 0.75 / std::numbers::pi, 1, 0.01 * std::pow(h, 4));
  }
}

// If closely spaced rows of control points moved far along the meridian, the surface would be folded, and its area would be 2 to 10 % too large.
TEST(PolarSphere, IsNotFoldedWhereRowsAreCloserThanThePointsOfARow) {
  for (const auto& [m, r] : {std::array{16, 32}, {16, 48}, {24, 96}})
    for (const PoleRule rule : {PoleRule::c1, PoleRule::bezier_transform}) {
      const spline::PolarMesh mesh{m, r, rule};
      const spline::Space space = spline::space(mesh);
      EXPECT_NEAR(measures(space, unit_sphere(mesh, space, 2)).area / (4 * std::numbers::pi), 1, 2e-5) << m << " " << r;  // error for m = 16
    }
}

TEST(PolarShapes, HaveThePositionAndOrientationOfTheDeck) {
  for (const PoleRule rule : every_rule) {
    const spline::PolarMesh mesh{16, 8, rule};
    const spline::Space space = spline::space(mesh);
    ParticleShape shape;
    shape.shape = "spheroid";
    shape.semi_axes = Vec3(2, 1, 1);
    shape.orientation = Vec3(0, 0, 90);  // rotates the particle's x1 to x2
    shape.center = Vec3(1, 2, 3);
    const Net net = resting_shape(space, mesh, 0, shape);
    const Deformation d = deformation(Geometry(space), net);
    EXPECT_NEAR(d.lengths[0], 2, 1e-3);
    EXPECT_NEAR(d.lengths[1], 4, 1e-3);
    EXPECT_LT((measures(space, net).centroid - shape.center).norm(), 1e-5);
    EXPECT_NEAR(net(0, 1), 0, 1e-2);  // the pole at the negative end of the long axis
  }
}

TEST(PolarShapes, RedCellHasTheVolumeOfItsOutline) {
  // V = 2 pi int_0^1 sqrt(1 - r^2) (0.21 + 2 r^2 - 1.12 r^4) r dr
  const double exact = 2 * std::numbers::pi * (0.21 / 3 + 2.0 * 2 / 15 - 1.12 * 8 / 105);
  for (const PoleRule rule : every_rule) {
    const spline::PolarMesh mesh{32, 16, rule};
    const spline::Space space = spline::space(mesh);
    ParticleShape shape;
    shape.shape = "red cell";
    shape.radius = 1;
    EXPECT_NEAR(volume(space, resting_shape(space, mesh, 2, shape)) / exact, 1, 2e-4);
  }
}

TEST(PolarShapes, CanBePartitioned) {
  const spline::Space space = spline::space({16, 8, PoleRule::bezier_transform});
  const Partition p = partition_of_points(space, 3, indices(space.n_points));
  std::vector<int> points(3, 0);
  for (const int owner : p.point_owner) ++points[owner];
  for (const int n : points) EXPECT_NEAR(n, space.n_points / 3., 0.1 * space.n_points);
}

}  // namespace
}  // namespace tanktread::surface
