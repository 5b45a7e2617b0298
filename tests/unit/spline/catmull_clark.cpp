#include "spline/extraordinary.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "samples.hpp"
#include "spline/extraction.hpp"
#include "spline/locate.hpp"

namespace tanktread::spline {
namespace {

constexpr auto rule = ExtraordinaryRule::catmull_clark;

TEST(CatmullClark, PiecesArePositiveAndSumToOne) {
  const auto pieces = catmull_clark_pieces(4);
  ASSERT_EQ(pieces.size(), 13u);
  double area = 0;
  for (const Piece& p : pieces) {
    EXPECT_GE(p.extraction.minCoeff(), 0);
    EXPECT_LT((p.extraction.colwise().sum().array() - 1).abs().maxCoeff(), 1e-14);
    area += p.size * p.size;
  }
  EXPECT_EQ(area, 1);
}

TEST(CatmullClark, SubdivisionHasTheKnownDoubleSubdominantEigenvalue) {
  // lambda = (5 + c + sqrt((18 + 2 c) (1 + c) / 2)) / 16 with c = cos(2 pi / 3): 0.41010. Source: Stam 1998.
  Eigen::VectorXd values = catmull_clark_subdivision().eigenvalues().real();
  std::sort(values.data(), values.data() + values.size(), std::greater<>());
  const double c = -0.5, expected = (5 + c + std::sqrt((18 + 2 * c) * (1 + c) / 2)) / 16;
  EXPECT_NEAR(values[0], 1, 1e-13);
  EXPECT_NEAR(values[1], expected, 1e-13);
  EXPECT_NEAR(values[2], expected, 1e-13);
}

TEST(CatmullClark, TheCornerOfTheInnermostSquareTendsToTheLimitPoint) {
  // Limit stencil of valence 3: (9 P + 4 sum E + sum F) / 24.
  const auto pieces = catmull_clark_pieces(20);
  const Eigen::VectorXd corner = pieces.back().extraction.col(0);
  EXPECT_NEAR(corner[OneRing::P], 9. / 24, 1e-12);
  for (int j = 0; j < 3; ++j) {
    EXPECT_NEAR(corner[OneRing::E + j], 4. / 24, 1e-12);
    EXPECT_NEAR(corner[OneRing::F + j], 1. / 24, 1e-12);
  }
}

TEST(CatmullClark, FieldsAreC2AcrossAllSidesButThoseOfTheInnermostSquares) {
  const TMesh mesh = cube(3);
  const Space s = space(mesh, rule);
  const Net net = random_net(s.n_points, 4);
  const Locator locate(s);
  const double cap = 1.0 / (3 * 16), size = 1.0 / 3;
  double jump = 0, bend = 0;
  for (int k = 0; k < int(s.elements.size()); ++k) {
    const Element& e = s.elements[k];
    if (e.size[0] < 1.5 * cap) continue;
    // Compares the element with its neighbour across the right side, unless this is on another macro face or is an innermost square.
    const double x = e.origin[0] + e.size[0];
    if (x > 1 - 1e-9) continue;
    for (double t : {0.2, 0.8}) {
      const double y = e.origin[1] + t * e.size[1];
      const Site there = locate({e.face, x + 1e-6, y});
      const Element& f = s.elements[there.element];
      if (f.size[0] < 1.5 * cap) continue;
      const Basis a = basis(e, 1, t, 2), b = basis(f, 0, (y - f.origin[1]) / f.size[1], 2);
      const double ha = e.size[0] / size, hb = f.size[0] / size;
      const Eigen::RowVector3d value = a.value.transpose() * net_of(e, net) - b.value.transpose() * net_of(f, net);
      const Eigen::RowVector3d slope = a.s.transpose() * net_of(e, net) / ha - b.s.transpose() * net_of(f, net) / hb;
      const Eigen::RowVector3d second = a.ss.transpose() * net_of(e, net) / (ha * ha) - b.ss.transpose() * net_of(f, net) / (hb * hb);
      jump = std::max({jump, value.norm(), slope.norm()});
      bend = std::max(bend, second.norm());
    }
  }
  EXPECT_LT(jump, 1e-13);
  EXPECT_LT(bend, 1e-10);  // rounding of 1e-16 divided by the squared side 2^-8 of the smallest piece
}

TEST(CatmullClark, AllPiecesAroundASiteHaveTheSameValue) {
  const TMesh mesh = cube(4);
  const Space s = space(mesh, rule);
  const Net net = random_net(s.n_points, 8);
  const auto anchor = anchors(mesh);
  for (int i = 0; i < s.n_points; ++i) {
    EXPECT_EQ(int(s.collocation[i].size()), mesh.lattice->valence(anchor[i]));
    for (const Site& site : s.collocation[i]) EXPECT_LT((value_at(s, net, site) - value_at(s, net, s.collocation[i][0])).norm(), 1e-13);
  }
}

TEST(CatmullClark, TheInnermostSquareHasTheSameSideOnAllLevels) {
  for (int levels : {0, 2, 4}) {
    const Space s = space(cube(3, levels), rule);
    double smallest = 1;
    for (const Element& e : s.elements) smallest = std::min(smallest, e.size[0]);
    EXPECT_EQ(smallest, 1.0 / 3 / 16);
  }
  EXPECT_EQ(space(cube(3), rule).elements.size(), 30u + 24 * 13);
}

}  // namespace
}  // namespace tanktread::spline
