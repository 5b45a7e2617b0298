#include "spline/extraction.hpp"

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <set>
#include <utility>

#include "base/types.hpp"
#include "samples.hpp"
#include "sequences.hpp"
#include "spline/basis.hpp"
#include "spline/bernstein.hpp"
#include "spline/extraordinary.hpp"
#include "spline/locate.hpp"

namespace tanktread::spline {
namespace {

TEST(Extraction, EveryRegularElementHasSixteenFunctionsThatSumToOne) {
  for (int n : {3, 4, 6, 12}) {
    const Space s = space(cube(n), ExtraordinaryRule::g1);
    EXPECT_EQ(s.n_points, 6 * n * n + 2);
    int regular = 0;
    for (const Element& e : s.elements) {
      regular += e.degree == 3;
      EXPECT_EQ(e.points.size(), e.degree == 3 ? 16u : 19u);
      EXPECT_EQ(e.extraction->rows(), Eigen::Index(e.points.size()));
      EXPECT_LT((e.extraction->colwise().sum().array() - 1).abs().maxCoeff(), 1e-14);
    }
    EXPECT_EQ(regular, 6 * n * n - 24);
  }
}

TEST(Extraction, EqualMatricesAreSharedWithinSpacesAndAcrossThem) {
  const Space before = space(cube(4), ExtraordinaryRule::g1), finer = space(cube(6), ExtraordinaryRule::g1);
  Space one = before, copy = space(cube(4), ExtraordinaryRule::g1), other = finer;
  share_extraction(std::array{&one, &copy, &other});
  const auto distinct = [](const Space& s) {
    std::set<const Eigen::MatrixXd*> all;
    for (const Element& e : s.elements) all.insert(e.extraction.get());
    return all;
  };
  EXPECT_LT(distinct(one).size(), one.elements.size());
  EXPECT_EQ(distinct(one), distinct(copy));
  EXPECT_NE(distinct(one), distinct(other));
  for (const auto& [shared, own] : {std::pair{&one, &before}, {&copy, &before}, {&other, &finer}})
    for (std::size_t k = 0; k < own->elements.size(); ++k) EXPECT_EQ(*shared->elements[k].extraction, *own->elements[k].extraction);
  const Space* const both[] = {&one, &copy};
  EXPECT_EQ(distinct(stacked(both)), distinct(one));
}

TEST(Extraction, UnusedLevelsOfTheLatticeHaveNoEffect) {
  const Space a = space(cube(4, 0), ExtraordinaryRule::g1), b = space(cube(4, 2), ExtraordinaryRule::g1);
  ASSERT_EQ(a.elements.size(), b.elements.size());
  for (std::size_t k = 0; k < a.elements.size(); ++k) {
    EXPECT_EQ(a.elements[k].origin, b.elements[k].origin);
    EXPECT_EQ(a.elements[k].size, b.elements[k].size);
  }
}

/// Compares the extraction with its averaging form: the inner Bezier point of a face next to corner P0 is (4 P0 + 2 P1 + P2 + 2 P3) / 9, and a point
/// on a side is the mean of its two neighbours across the side. Source: Scott et al. 2013, T-spline extraction; valid on uniform meshes.
TEST(Extraction, IsTheAveragingFormOnAUniformMesh) {
  const TMesh mesh = cube(4);
  const Space s = space(mesh, ExtraordinaryRule::g1);
  const auto point = control_points(mesh);
  const Net net = random_net(s.n_points, 7);
  const Tiling tiles = elements(mesh);
  for (std::size_t k = 0; k < s.elements.size(); ++k) {
    const Element& e = s.elements[k];
    if (e.degree != 3) continue;
    const Eigen::MatrixXd Q = e.extraction->transpose() * net_of(e, net);
    const auto c = corners(*mesh.lattice, tiles.tiles[k]);
    const int at[4] = {5, 6, 10, 9};  // inner Bezier points in the order of the corners
    for (int i = 0; i < 4; ++i) {
      const Eigen::RowVector3d expected = (4 * net.row(point[c[i]]) + 2 * net.row(point[c[(i + 1) & 3]]) + net.row(point[c[(i + 2) & 3]]) +
                                           2 * net.row(point[c[(i + 3) & 3]])) /
                                          9;
      EXPECT_LT((Q.row(at[i]) - expected).norm(), 1e-14);
    }
  }
}

/// Compares the values, gradients and second derivatives of a random field on both sides of each side of each element, with respect to the
/// coordinates of the macro face.
TEST(Extraction, FieldsAreC2AcrossRegularSidesAndG1AtExtraordinaryPoints) {
  const TMesh mesh = cube(4);
  const Space s = space(mesh, ExtraordinaryRule::g1);
  const Net net = random_net(s.n_points, 3);
  double c0 = 0, c2 = 0, c1_around = 0, g1 = 0;
  for (const SharedSide& side : shared_sides(mesh, s)) {
    for (double x : {0.0, 0.3, 0.75, 1.0}) {
      const Jet a = jet_across(s, net, side.element[0], side.edge[0], x), b = jet_across(s, net, side.element[1], side.edge[1], 1 - x);
      const bool bent_a = s.elements[side.element[0]].degree == 4, bent_b = s.elements[side.element[1]].degree == 4;
      c0 = std::max(c0, (a.value - b.value).norm());
      if (!bent_a && !bent_b) c2 = std::max({c2, (a.slope + b.slope).norm(), (a.bend - b.bend).norm()});
      if (bent_a != bent_b) c1_around = std::max(c1_around, (a.slope + b.slope).norm());
      // Tangent planes agree if the two derivatives across the side and the derivative along it are linearly dependent.
      if (bent_a && bent_b) {
        Mat3 m;
        m << a.slope, b.slope, a.along;
        g1 = std::max(g1, std::abs(m.determinant()));
      }
    }
  }
  EXPECT_LT(c0, 1e-13);  // round-off of sums of 16 to 19 values of order 1
  EXPECT_LT(c2, 1e-12);  // round-off of second derivatives
  EXPECT_LT(c1_around, 1e-12);
  EXPECT_LT(g1, 1e-12);
}

TEST(Extraction, AnAffineMapOfTheControlPointsIsAnAffineMapOfTheSurface) {
  const Space s = space(cube(3), ExtraordinaryRule::g1);
  const Net net = random_net(s.n_points, 5);
  Mat3 A;
  A << 1, 2, 3, -1, 0.5, 0, 2, 1, -1;
  const Eigen::RowVector3d shift(0.3, -2, 1);
  Net moved = net * A.transpose();
  moved.rowwise() += shift;
  for (const Element& e : s.elements) {
    const Basis b = basis(e, 0.3, 0.8, 0);
    const Eigen::RowVector3d x = b.value.transpose() * net_of(e, net), y = b.value.transpose() * net_of(e, moved);
    EXPECT_LT((x * A.transpose() + shift - y).norm(), 1e-13);
  }
}

TEST(Extraction, BasisDerivativesAreDifferenceQuotients) {
  const Space s = space(cube(3), ExtraordinaryRule::g1);
  const double h = 1e-4;  // second differences: h^2 truncation, 1e-16 / h^2 rounding
  for (int k : {0, 4}) {
    const Element& e = s.elements[k];
    const Basis b = basis(e, 0.4, 0.7, 2), r = basis(e, 0.4 + h, 0.7, 1), l = basis(e, 0.4 - h, 0.7, 1), u = basis(e, 0.4, 0.7 + h, 1),
                d = basis(e, 0.4, 0.7 - h, 1);
    EXPECT_LT((b.s - (r.value - l.value) / (2 * h)).norm(), 1e-7);
    EXPECT_LT((b.t - (u.value - d.value) / (2 * h)).norm(), 1e-7);
    EXPECT_LT((b.ss - (r.s - l.s) / (2 * h)).norm(), 1e-7);
    EXPECT_LT((b.st - (u.s - d.s) / (2 * h)).norm(), 1e-7);
    EXPECT_LT((b.tt - (u.t - d.t) / (2 * h)).norm(), 1e-7);
  }
}

TEST(ExtraordinaryG1, QuarticExtractionHasItsPublishedValues) {
  // Source: constrained Bezier extraction for valence 3 from a public plug-in file, derived again as a full least-squares problem; row of the
  // Bernstein polynomial (1, 1).
  const Eigen::MatrixXd c = constrained_biquartic();
  EXPECT_NEAR(c(6, OneRing::P), 0.48611111111111105, 1e-14);
  EXPECT_NEAR(c(6, OneRing::E), 0.18558010926025434, 1e-14);
  EXPECT_NEAR(c(6, OneRing::E + 2), 0.052450892590602434, 1e-14);
  EXPECT_NEAR(c(6, OneRing::F), 0.07762714689434194, 1e-14);
  EXPECT_LT((c.rowwise().sum().array() - 1).abs().maxCoeff(), 1e-14);
}

TEST(Greville, SitesAreTheAnchorsOfAUniformMeshInEveryElementAround) {
  const TMesh mesh = cube(4);
  const Space s = space(mesh, ExtraordinaryRule::g1);
  const auto anchor = anchors(mesh);
  for (int i = 0; i < s.n_points; ++i) {
    EXPECT_EQ(int(s.collocation[i].size()), mesh.lattice->valence(anchor[i]));
    for (const Site& site : s.collocation[i]) {
      EXPECT_TRUE(site.s == 0 || site.s == 1);
      EXPECT_TRUE(site.t == 0 || site.t == 1);
    }
  }
}

TEST(Greville, AllSitesOfAPointSeeTheSameField) {
  const Space s = space(cube(5), ExtraordinaryRule::g1);
  const Net net = random_net(s.n_points, 11);
  for (const auto& sites : s.collocation)
    for (const Site& site : sites) EXPECT_LT((value_at(s, net, site) - value_at(s, net, sites[0])).norm(), 1e-13);
}

TEST(Greville, CollocationIsWellConditioned) {
  for (int n : {3, 6}) {
    const Eigen::MatrixXd C = collocation_matrix(space(cube(n), ExtraordinaryRule::g1));
    EXPECT_LT(condition_number(C), 9.1);  // 9.0 measured; the symbol of cubic splines at the knots gives 9 for a plane
    EXPECT_GT(C.diagonal().minCoeff(), 0.44);   // 4/9 on a uniform mesh
  }
}

TEST(Locate, FindsTheElementOfEveryPoint) {
  const TMesh mesh = cube(4, 1);
  const Space s = space(mesh, ExtraordinaryRule::g1);
  const Locator locate(s);
  for (int k = 0; k < int(s.elements.size()); ++k) {
    const Site site = locate(place(s, Site{k, 0.25, 0.5}));
    EXPECT_EQ(site.element, k);
    EXPECT_NEAR(site.s, 0.25, 1e-12);
    EXPECT_NEAR(site.t, 0.5, 1e-12);
  }
  const Net net = random_net(s.n_points, 2);
  const auto anchor = anchors(mesh);
  for (int i = 0; i < s.n_points; ++i)
    EXPECT_LT((value_at(s, net, locate(place(*mesh.lattice, anchor[i]))) - value_at(s, net, s.collocation[i][0])).norm(), 1e-13);
}

}  // namespace
}  // namespace tanktread::spline
