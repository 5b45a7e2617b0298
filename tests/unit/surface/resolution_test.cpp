#include "surface/metrics.hpp"

#include <cmath>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "spline/extraction.hpp"
#include "spline/locate.hpp"
#include "spline/refinement.hpp"
#include "spline/transfer.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"
#include "surfaces.hpp"

namespace tanktread::surface {
namespace {

double largest_surface_error(const std::vector<std::array<Resolution, 2>>& all) {
  double largest = 0;
  for (const auto& element : all)
    for (const Resolution& along : element) largest = std::max(largest, along.errors[Criterion::surface]);
  return largest;
}

TEST(Resolution, AnUndeformedParticleHasNoError) {
  // Rotated, translated and inflated: x = c Q X + d, so F = c Q.
  const CubeMesh cube(6, spline::ExtraordinaryRule::catmull_clark);
  const Net rest = cube.sphere();
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  const Net net = (1.7 * rest * turn.transpose()).rowwise() + Vec3(0.3, -2, 1).transpose();
  EXPECT_LT(largest_surface_error(resolution(cube.mesh, cube.space, rest, net, {})), 1e-15);
}

TEST(Resolution, AFourthPowerHasItsFourthDifferenceAlongOneDirectionOnly) {
  // phi = (n x)^4 in the coordinate of the face: the fourth difference is 4! = 24 if five points lie on one face.
  const int n = 8;
  const CubeMesh cube(n, spline::ExtraordinaryRule::catmull_clark);
  const Net rest = cube.sphere();
  const FieldAt phi = [&](const spline::Site& site) { return Vec3(std::pow(n * spline::place(cube.space, site).x, 4), 0, 0); };
  const auto found = resolution(cube.mesh, cube.space, rest, rest, phi);
  const auto tiles = spline::elements(cube.mesh).tiles;
  int counted = 0;
  for (std::size_t e = 0; e < tiles.size(); ++e) {
    const int unit = tiles[e].width;
    if (tiles[e].x < 3 * unit || tiles[e].x > (n - 4) * unit || tiles[e].y < 3 * unit || tiles[e].y > (n - 4) * unit) continue;
    ++counted;
    EXPECT_NEAR(found[e][0].errors[Criterion::load], 24. / 384, 1e-9);  // round-off of values up to 4096
    EXPECT_NEAR(found[e][1].errors[Criterion::load], 0, 1e-9);
  }
  EXPECT_EQ(counted, 6 * 2 * 2);
}

TEST(Resolution, HalvingElementsDividesTheErrorBySixteen) {
  const auto errors = [](int n) {
    const CubeMesh cube(n, spline::ExtraordinaryRule::catmull_clark);
    const Net rest = cube.sphere();
    const FieldAt bump = [&](const spline::Site& site) { return Vec3(std::sin(2 * value(cube.space, rest, site)[0]), 0, 0); };
    const FieldsAt fields = [&](const spline::Site& site) { return Eigen::VectorXd(Eigen::Vector2d(3, -4) * bump(site)[0]); };
    Errors sum;
    const auto found = resolution(cube.mesh, cube.space, rest, rest, bump, fields);
    for (const auto& element : found) sum = sum + element[0].errors + element[1].errors;
    return sum * (1 / static_cast<double>(found.size()));
  };
  const Errors coarse = errors(12), fine = errors(24);
  for (const Criterion criterion : {Criterion::load, Criterion::fields}) {
    const double order = std::log2(coarse[criterion] / fine[criterion]);
    EXPECT_GT(order, 3.5);  // lines at extraordinary points, a fraction 1/n of all lines, have a lower order
    EXPECT_LT(order, 4.1);
  }
}

TEST(Resolution, AFieldProportionalToPositionHasNoErrorAtExtraordinaryPoints) {
  // The field is q = x. Its fourth differences along the surface come from the parametrisation, which is not smooth at extraordinary points.
  const auto largest = [](int n, Criterion which) {
    const CubeMesh cube(n, spline::ExtraordinaryRule::catmull_clark);
    const Net rest = cube.sphere();
    const FieldAt place = field_of_net(cube.space, rest);
    double most = 0;
    for (const auto& element : resolution(cube.mesh, cube.space, rest, rest, place, [&](const spline::Site& site) { return place(site); }))
      most = std::max({most, element[0].errors[which], element[1].errors[which]});
    return most;
  };
  EXPECT_LT(largest(16, Criterion::fields), largest(8, Criterion::fields) / 6);  // expected factor at an extraordinary point: 8
  EXPECT_GT(largest(16, Criterion::load), largest(8, Criterion::load) / 3);      // estimate without the correction for the parametrisation
}

TEST(Resolution, TheEstimatedErrorAfterMergingIsThatOfTheCoarserMesh) {
  const spline::TMesh coarse = spline::cube(6, 1);
  std::vector<spline::Mark> all;
  for (int e = 0; e < 216; ++e) all.push_back({e});
  const spline::TMesh fine = spline::refine(coarse, all).mesh;
  const spline::Space before = spline::space(coarse, spline::ExtraordinaryRule::catmull_clark);
  const spline::Space after = spline::space(fine, spline::ExtraordinaryRule::catmull_clark);
  const Net rest = unit_sphere(coarse, LeastSquaresFit(before)), same = spline::transfer(before, after)(rest).net;
  const auto errors = [](const spline::TMesh& mesh, const spline::Space& space, const Net& net, Errors Resolution::*which) {
    const FieldAt bump = [&](const spline::Site& site) { return Vec3(std::sin(3 * value(space, net, site)[0]), 0, 0); };
    double sum = 0;
    for (const auto& element : resolution(mesh, space, net, net, bump))
      sum += (element[0].*which)[Criterion::load] + (element[1].*which)[Criterion::load];
    return sum / static_cast<double>(spline::elements(mesh).tiles.size());
  };
  const double was = errors(coarse, before, rest, &Resolution::errors);
  EXPECT_NEAR(errors(fine, after, same, &Resolution::merged), was, 0.03 * was);  // edges inside the doubled element are included too
  EXPECT_NEAR(errors(coarse, before, rest, &Resolution::merged), 16 * was, 1e-12 * was);
}

struct PolarSphere {
  spline::TMesh mesh = spline::polar(12, 8, 1);
  spline::Space space = spline::space(mesh, spline::PoleRule::plain);
  Net net = unit_sphere({12, 8, spline::PoleRule::plain}, space);
};

TEST(Resolution, OfAPolarMeshVanishesWithoutDeformationAndIsFiniteAtThePoles) {
  const PolarSphere sphere;
  const Net net = (1.7 * sphere.net).rowwise() + Vec3(0.3, -2, 1).transpose();
  EXPECT_LT(largest_surface_error(resolution(sphere.mesh, sphere.space, sphere.net, net, {})), 1e-15);
  // phi = x J0/J with J = 1.7^2 J0: the quotient has a limit at a pole.
  const Net load = 1.7 * 1.7 * sphere.net;
  const auto found = resolution(sphere.mesh, sphere.space, sphere.net, net, per_current_area(sphere.space, sphere.net, net, load));
  const auto tiles = spline::elements(sphere.mesh).tiles;
  ASSERT_EQ(found.size(), 12u * 8u);
  for (std::size_t e = 0; e < found.size(); ++e) {
    const bool at_pole = spline::is_degenerate(*sphere.mesh.lattice, tiles[e]);
    EXPECT_EQ(at_pole, e < 12 || e >= 12 * 7);
    EXPECT_GT(found[e][1].length, 0.2);
    EXPECT_GT(found[e][0].length, at_pole ? 0.15 : 0.2);  // length of the side that is not the pole
    // sin(x) has the fourth difference 16 sin(d/2)^4 sin(x), which is below d^4, with d = pi/8 along a meridian and pi/6 around.
    EXPECT_LT(found[e][0].errors[Criterion::load], std::pow(3.15 / 6, 4) / 384);
    EXPECT_LT(found[e][1].errors[Criterion::load], 1.3 * std::pow(3.15 / 8, 4) / 384);  // rows are not exactly evenly spaced
  }
}

}  // namespace
}  // namespace tanktread::surface
