// Tests of reflections that map surfaces onto themselves, and of symmetric fields.

#include "surface/symmetry.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "spline/refinement.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"
#include "surfaces.hpp"

namespace tanktread::surface {
namespace {

const auto always = [](const Image&) { return true; };

Symmetry of(const spline::Space& space, const Net& net) {
  const Net* nets[] = {&net};
  return symmetry(space, nets, always);
}

TEST(Symmetry, OfACubeMeshOnAlignedEllipsoidsIsEveryReflectionOfCoordinates) {
  for (const int n : {3, 4, 6}) {
    const CubeMesh cube(n);
    const Symmetry found = of(cube.space, cube.ellipsoid({1.3, 1, 0.8}, Vec3::Zero(), {0.3, -0.2, 0.1}));
    EXPECT_EQ(found.order(), 8);
    EXPECT_EQ(found.description(), "mirror x1, mirror x2 and mirror x3");
  }
}

TEST(Symmetry, OfARotatedMeshIsThatOfTheMesh) {
  const CubeMesh cube(4);
  EXPECT_EQ(of(cube.space, cube.ellipsoid({1, 1, 1}, {10, 20, 30})).description(), "point symmetry");
  EXPECT_EQ(of(cube.space, cube.ellipsoid({1, 1, 1}, {0, 20, 0})).description(), "mirror x2 and point symmetry");
  EXPECT_EQ(of(cube.space, cube.crumpled(0.02)).description(), "none");
}

TEST(Symmetry, OfCatmullClarkAndPolarMeshes) {
  const CubeMesh smooth(3, spline::ExtraordinaryRule::catmull_clark);
  EXPECT_EQ(of(smooth.space, smooth.sphere()).order(), 8);
  const spline::PolarMesh mesh{8, 6, spline::PoleRule::bezier_transform};
  const spline::Space even = spline::space(mesh);
  EXPECT_EQ(of(even, unit_sphere(mesh, even)).order(), 8);
  const spline::PolarMesh odd{7, 6, spline::PoleRule::plain};
  const spline::Space space = spline::space(odd);
  EXPECT_LT(of(space, unit_sphere(odd, space)).order(), 8);
}

TEST(Symmetry, IsLostIfOneElementIsDivided) {
  const spline::TMesh cut = spline::refine(spline::cube(8, 1), {{8 * 3 + 3, true, true}}).mesh;
  const spline::Space space = spline::space(cut, spline::ExtraordinaryRule::g1);
  ParticleShape shape;
  shape.radius = 1;
  EXPECT_LT(of(space, resting_shape(space, cut, shape)).order(), 8);
}

TEST(Symmetry, IsKeptIfImagesAreDividedToo) {
  const spline::TMesh whole = spline::cube(6, 2);
  ParticleShape shape;
  shape.radius = 1;
  for (const Vec3& turned : {Vec3(0, 0, 0), Vec3(20, 35, 50)}) {
    shape.orientation = turned;
    const spline::Space space = spline::space(whole, spline::ExtraordinaryRule::catmull_clark);
    const Symmetry found = of(space, resting_shape(space, whole, shape));
    spline::RepairRules rules;
    for (const Image& image : found.images())
      rules.images.push_back(spline::lattice_map(whole, space, image.element, image.signs.prod() < 0).value());
    const spline::TMesh cut = spline::refine(whole, {{8, true, true}, {100, true, false}}, rules).mesh;
    const spline::Space finer = spline::space(cut, spline::ExtraordinaryRule::catmull_clark);
    EXPECT_EQ(of(finer, resting_shape(finer, cut, shape)).description(), found.description());
  }
}

TEST(Symmetry, FundamentalPointsAreOneOfEachSetOfImages) {
  const CubeMesh cube(6);
  const Net net = cube.sphere();
  const Symmetry found = of(cube.space, net);
  // 218 points; each plane contains 24 points, 2 of them on each axis: (218 + 3 24 + 3 2) / 8 orbits
  EXPECT_EQ(found.fundamental().size(), 37u);
  for (const int a : found.fundamental()) EXPECT_GE(net.row(a).minCoeff(), -1e-12);
}

TEST(Symmetry, CompletesSymmetricFields) {
  const CubeMesh cube(4);
  const Net net = cube.ellipsoid({1.3, 1, 0.8});
  const Net* nets[] = {&net};
  // The symmetry of a shear flow: mirror plane x2 and half turn about x2.
  const Symmetry found = symmetry(cube.space, nets, [](const Image& image) { return image.signs[0] == image.signs[2]; });
  EXPECT_EQ(found.order(), 4);
  EXPECT_EQ(found.description(), "mirror x2 and point symmetry");
  Net exact(net.rows(), 3);
  for (Eigen::Index a = 0; a < net.rows(); ++a) {
    const Vec3 x = net.row(a).transpose();
    exact.row(a) << x[2] * (1 + x[0] * x[2]), x[1] * (x[0] * x[0] + x[2] * x[0]), x[0] * x[0] * x[0] - x[2] * x[1] * x[1];
  }
  const Net gradient = Geometry(cube.space).volume_gradient(net);
  for (const Net& field : {exact, gradient}) {
    Net known = Net::Constant(net.rows(), 3, 7.0);
    for (const int a : found.fundamental()) known.row(a) = field.row(a);
    found.complete(known);
    EXPECT_NEAR((known - field).cwiseAbs().maxCoeff(), 0, 1e-12);
  }
}

TEST(Symmetry, FundamentalElementsFoldedGiveTheSumsOfAll) {
  for (const int n : {4, 5}) {  // with five per side, elements on the planes are images of themselves
    const CubeMesh cube(n);
    const Net net = cube.ellipsoid({1.3, 1, 0.8});
    const Symmetry found = of(cube.space, net);
    const auto points = [&](int e) { return std::span<const int>(cube.space.elements[static_cast<std::size_t>(e)].points); };
    const FundamentalElements one = fundamental_elements(found, static_cast<int>(cube.space.elements.size()), points);
    EXPECT_EQ(one.whole(), n == 4);
    double elements = 0;
    for (const double weight : one.weight) elements += found.order() * weight;
    EXPECT_EQ(elements, 6 * n * n);
    const Geometry geometry(cube.space);
    Net sums = Net::Zero(net.rows(), 3), part;
    for (std::size_t k = 0; k < one.element.size(); ++k) {
      geometry.volume_gradient(net, std::span(&one.element[k], 1), part);
      sums += one.weight[k] * part;
    }
    fold(found, sums);
    found.complete(sums);
    EXPECT_NEAR((sums - geometry.volume_gradient(net)).cwiseAbs().maxCoeff(), 0, 1e-12) << n;
  }
}

TEST(Symmetry, FieldsOfAllParitiesMakeUpAnyField) {
  const CubeMesh cube(6);  // the mirror planes contain control points
  const Symmetry found = of(cube.space, cube.sphere());
  const Net field = Net::Random(cube.space.n_points, 3);
  Net sum = Net::Zero(field.rows(), 3);
  Eigen::VectorXd scalar_sum = Eigen::VectorXd::Zero(field.rows());
  for (int k = 0; k < 8; ++k) {
    const Vec3 parity(k & 1 ? -1 : 1, k & 2 ? -1 : 1, k & 4 ? -1 : 1);
    Net part = field / 8;
    for (const Image& g : found.images()) {
      const double turned = (g.signs.array() < 0).select(parity, Vec3::Ones()).prod() / 8;
      for (Eigen::Index a = 0; a < field.rows(); ++a)
        part.row(g.point[static_cast<std::size_t>(a)]) += turned * field.row(a).cwiseProduct(g.signs.transpose());
    }
    const Parity other(found, parity);
    Net known = Net::Constant(field.rows(), 3, 7.0);
    for (const int a : found.fundamental()) known.row(a) = part.row(a);
    other.complete(known);
    EXPECT_NEAR((known - part).cwiseAbs().maxCoeff(), 0, 1e-14) << parity.transpose();
    sum += part;
    for (Eigen::Index a = 0; a < field.rows(); ++a) scalar_sum[a] += std::abs(other.scalar_signs()[a]);
  }
  EXPECT_NEAR((sum - field).cwiseAbs().maxCoeff(), 0, 1e-14);
  for (Eigen::Index a = 0; a < field.rows(); ++a)  // nonzero for as many parities as its orbit has points
    EXPECT_EQ(scalar_sum[a], std::ranges::count(found.source(), found.source()[static_cast<std::size_t>(a)]));
}

TEST(Symmetry, CompletedFieldsStayAsTheyAre) {
  const CubeMesh cube(5);
  const Symmetry found = of(cube.space, cube.sphere());
  Net once = Net::Random(cube.space.n_points, 3);
  found.complete(once);
  Net twice = once;
  found.complete(twice);
  EXPECT_EQ(once, twice);
}

}  // namespace
}  // namespace tanktread::surface
