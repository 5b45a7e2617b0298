#include "surface/bezier_points.hpp"

#include <gtest/gtest.h>

#include "surface/patch.hpp"
#include "surfaces.hpp"

namespace tanktread::surface {
namespace {

TEST(BezierPoints, BlocksHoldEveryElementOnceGroupedByDegree) {
  const CubeMesh cube(4);
  const std::vector<DegreeGroup> groups = groups_by_degree(cube.space);
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].degree, 3);
  EXPECT_EQ(groups[1].degree, 4);
  EXPECT_EQ(groups[1].elements.size(), 24u);  // three around each of the eight extraordinary points
  std::vector<int> held(cube.space.elements.size(), 0);
  for (const DegreeGroup& group : groups)
    for (const int e : group.elements) {
      ++held[e];
      EXPECT_EQ(group.degree, cube.space.elements[e].degree);
    }
  for (const int times : held) EXPECT_EQ(times, 1);
}

TEST(BezierPoints, MapAndDefinitionAgree) {
  const CubeMesh cube(3);
  const Net net = cube.crumpled(0.1);
  const BezierMap map(cube.space);
  for (int e = 0; e < map.n_elements(); ++e) {
    const spline::Element& element = cube.space.elements[e];
    Eigen::MatrixX3d mapped(map.n_bezier(e), 3);
    map.points(e, net, mapped.data());
    Net local(element.points.size(), 3);
    for (std::size_t a = 0; a < element.points.size(); ++a) local.row(a) = net.row(element.points[a]);
    EXPECT_LT((mapped - element.extraction->transpose() * local).cwiseAbs().maxCoeff(), 1e-14);  // sums of 19 terms of order one
  }
}

TEST(BezierPoints, BackwardMapIsTheTranspose) {
  const CubeMesh cube(3);
  const BezierMap map(cube.space);
  const Net net = cube.crumpled(0.1);
  for (int e = 0; e < map.n_elements(); ++e) {
    const Eigen::VectorXd weights = Eigen::VectorXd::Random(3 * map.n_bezier(e));
    Eigen::VectorXd points(weights.size());
    map.points(e, net, points.data());
    Net dual = Net::Zero(map.n_points(), 3);
    map.add_transposed(e, weights.data(), dual);
    EXPECT_NEAR(points.dot(weights), dual.cwiseProduct(net).sum(), 1e-12);
  }
}

TEST(BezierPoints, DerivativesOfAPatchAreThoseOfItsPositions) {
  const CubeMesh cube(3);
  const Net net = cube.crumpled(0.1);
  for (const int e : {0, 4}) {  // next to an extraordinary point, and regular
    const ElementPoints element(cube.space, net, e);
    const Patch patch = element.patch();
    const double s = 0.3, t = 0.8, h = 1e-4;
    const Jet at = jet(patch, s, t);
    EXPECT_LT((at.x - position(patch, s, t)).norm(), 1e-15);
    // The errors of central differences are h^2 times a third derivative of order one, or round-off divided by h^2 = 1e-8.
    EXPECT_LT(((position(patch, s + h, t) - position(patch, s - h, t)) / (2 * h) - at.s).norm(), 1e-7);
    EXPECT_LT(((position(patch, s, t + h) - position(patch, s, t - h)) / (2 * h) - at.t).norm(), 1e-7);
    EXPECT_LT(((jet(patch, s + h, t).s - jet(patch, s - h, t).s) / (2 * h) - at.ss).norm(), 1e-7);
    EXPECT_LT(((jet(patch, s, t + h).s - jet(patch, s, t - h).s) / (2 * h) - at.st).norm(), 1e-7);
    EXPECT_LT(((jet(patch, s, t + h).t - jet(patch, s, t - h).t) / (2 * h) - at.tt).norm(), 1e-7);
  }
}

}  // namespace
}  // namespace tanktread::surface
