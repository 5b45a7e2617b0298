#include "surface/bezier_points.hpp"

#include <gtest/gtest.h>

#include "surface/patch.hpp"
#include "surfaces.hpp"

namespace tanktread::surface {
namespace {

TEST(BezierPoints, BlocksHoldEveryElementOnceGroupedByDegree) {
  const CubeMesh cube(4);
  const Blocks blocks = blocks_by_degree(cube.space);
  ASSERT_EQ(blocks.blocks.size(), 2u);
  EXPECT_EQ(blocks.blocks[0].degree, 3);
  EXPECT_EQ(blocks.blocks[1].degree, 4);
  EXPECT_EQ(blocks.blocks[1].elements.size(), 24u);  // three around each of eight extraordinary points
  for (int e = 0; e < static_cast<int>(cube.space.elements.size()); ++e) {
    const auto [block, position] = blocks.place[e];
    EXPECT_EQ(blocks.blocks[block].elements[position], e);
    EXPECT_EQ(blocks.blocks[block].degree, cube.space.elements[e].degree);
  }
}

TEST(BezierPoints, MapAndDefinitionAgree) {
  const CubeMesh cube(3);
  const Net net = cube.crumpled(0.1);
  const BezierMap map(cube.space);
  for (const Block& block : map.blocks().blocks) {
    Eigen::MatrixXd mapped;
    map.points(block, net, mapped);
    const int n_e = static_cast<int>(block.elements.size());
    for (int k = 0; k < n_e; ++k) {
      const spline::Element& element = cube.space.elements[block.elements[k]];
      Net local(element.points.size(), 3);
      for (std::size_t a = 0; a < element.points.size(); ++a) local.row(a) = net.row(element.points[a]);
      const Eigen::MatrixXd expected = element.extraction.transpose() * local;
      for (int c = 0; c < 3; ++c)  // sums of 19 terms of order one
        EXPECT_LT((mapped.col(c * n_e + k) - expected.col(c)).cwiseAbs().maxCoeff(), 1e-14);
    }
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

TEST(BezierPoints, DerivativesOfAPatchAreThoseOfItsPlaces) {
  const CubeMesh cube(3);
  const Net net = cube.crumpled(0.1);
  for (const int e : {0, 4}) {  // at an extraordinary point, and regular
    const ElementPoints element(cube.space, net, e);
    const Patch patch = element.patch();
    const double s = 0.3, t = 0.8, h = 1e-4;
    const Jet at = jet(patch, s, t);
    EXPECT_LT((at.x - place(patch, s, t)).norm(), 1e-15);
    // Central differences err by h^2 times a third derivative of order one, or by round-off over h^2 = 1e-8.
    EXPECT_LT(((place(patch, s + h, t) - place(patch, s - h, t)) / (2 * h) - at.s).norm(), 1e-7);
    EXPECT_LT(((place(patch, s, t + h) - place(patch, s, t - h)) / (2 * h) - at.t).norm(), 1e-7);
    EXPECT_LT(((jet(patch, s + h, t).s - jet(patch, s - h, t).s) / (2 * h) - at.ss).norm(), 1e-7);
    EXPECT_LT(((jet(patch, s, t + h).s - jet(patch, s, t - h).s) / (2 * h) - at.st).norm(), 1e-7);
    EXPECT_LT(((jet(patch, s, t + h).t - jet(patch, s, t - h).t) / (2 * h) - at.tt).norm(), 1e-7);
  }
}

}  // namespace
}  // namespace tanktread::surface
