#include "spline/polar.hpp"

#include <cmath>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "samples.hpp"
#include "sequences.hpp"
#include "spline/basis.hpp"

namespace tanktread::spline {
namespace {

const std::vector<PoleRule> every_rule = [] {
  std::vector<PoleRule> all;
  for (std::size_t k = 0; k < pole_rules.size(); ++k) all.push_back(static_cast<PoleRule>(k));
  return all;
}();

TEST(Polar, HasTheControlPointsOfThePaper) {
  for (const auto& [m, r, n] : {std::array{8, 4, 42}, {16, 8, 146}, {32, 16, 546}, {64, 32, 2114}, {40, 20, 842}, {20, 10, 222}}) {
    for (const PoleRule rule : every_rule) {
      const PolarMesh mesh{m, r, rule};
      const Space s = space(mesh);
      if (properties(rule).points == 1) {
        EXPECT_EQ(s.n_points, n);
      }
      if (rule == PoleRule::c1) {
        EXPECT_EQ(s.n_points, (r - 1) * m + 6);
      }
      EXPECT_EQ(s.n_points, int(polar_anchors(mesh).size()));
      EXPECT_EQ(int(s.collocation.size()), s.n_points);
      EXPECT_EQ(int(s.elements.size()), properties(rule).replaces_elements ? m * (r - 2) + 2 * m * 12 : m * r);
    }
  }
}

TEST(Polar, FunctionsSumToOneAndUseEveryControlPoint) {
  for (const PoleRule rule : every_rule) {
    const Space s = space({9, 5, rule});
    std::set<int> used;
    double area = 0;
    for (const Element& e : s.elements) {
      used.insert(e.points.begin(), e.points.end());
      EXPECT_EQ(e.degree, 3);
      EXPECT_EQ(e.extraction->rows(), Eigen::Index(e.points.size()));
      EXPECT_LT((e.extraction->colwise().sum().array() - 1).abs().maxCoeff(), 1e-14);
      if (rule != PoleRule::bezier_transform) {  // the matrix of the Bezier transform has negative entries
        EXPECT_GE(e.extraction->minCoeff(), 0);
      }
      area += e.size[0] * e.size[1];
    }
    EXPECT_EQ(int(used.size()), s.n_points);
    EXPECT_NEAR(area, 1, 1e-13);
  }
}

/// If the control values are the meridian coordinates of the generalised Greville points, the field is the meridian coordinate.
TEST(Polar, ReproducesTheMeridianCoordinate) {
  const PolarMesh mesh{8, 6, PoleRule::plain};
  const Space s = space(mesh);
  Net net = Net::Zero(s.n_points, 3);
  const auto at = polar_anchors(mesh);
  for (int a = 0; a < s.n_points; ++a) net(a, 0) = at[a].u;
  for (std::size_t e = 0; e < s.elements.size(); ++e)
    for (const double t : {0.0, 0.3, 1.0}) EXPECT_NEAR(value_at(s, net, {int(e), 0.4, t})[0], (s.elements[e].origin[1] * 6) + t, 1e-13);
}

TEST(Polar, FieldsAreC2AcrossAllSidesBetweenThePoles) {
  const int m = 7, r = 5;
  for (const PoleRule rule : {PoleRule::plain, PoleRule::c1}) {
    const Space s = space({m, r, rule});
    const Net net = random_net(s.n_points, 3);
    double jump = 0;
    const auto compare = [&](int a, int edge_a, int b, int edge_b) {
      for (const double x : {0.0, 0.3, 1.0}) {
        const Jet one = jet_across(s, net, a, edge_a, x), other = jet_across(s, net, b, edge_b, 1 - x);
        jump = std::max({jump, (one.value - other.value).norm(), (one.slope + other.slope).norm(), (one.bend - other.bend).norm()});
      }
    };
    for (int j = 0; j < r; ++j)
      for (int i = 0; i < m; ++i) {
        compare(j * m + i, 1, j * m + (i + 1) % m, 3);
        if (j + 1 < r) compare(j * m + i, 2, (j + 1) * m + i, 0);
      }
    EXPECT_LT(jump, 1e-12);  // round-off of second derivatives of fields of order 1
  }
}

TEST(Polar, PlainElementsCollapseToThePole) {
  const Space s = space({6, 4, PoleRule::plain});
  const Net net = random_net(s.n_points, 5);
  for (const double x : {0.0, 0.3, 1.0}) {
    EXPECT_LT((value_at(s, net, {2, x, 0}) - net.row(0).transpose()).norm(), 1e-15);
    EXPECT_LT((value_at(s, net, {6 * 3 + 4, x, 1}) - net.row(s.n_points - 1).transpose()).norm(), 1e-15);
  }
}

/// Returns the largest difference between unit normals at the distance t from the first pole.
double spread_of_normals(const Space& s, const Net& net, int m, double t) {
  std::vector<Vec3> normals;
  for (int i = 0; i < m; ++i) {
    const Element& e = s.elements[i];
    const Basis b = basis(e, 0.35, t, 1);
    const Eigen::MatrixXd P = net_of(e, net);
    const Vec3 a1 = (b.s.transpose() * P).transpose(), a2 = (b.t.transpose() * P).transpose();
    normals.push_back(a1.cross(a2).normalized());
  }
  double spread = 0;
  for (const Vec3& n : normals) spread = std::max(spread, (n - normals[0]).norm());
  return spread;
}

TEST(Polar, NormalsAreSingleValuedAtAC1Pole) {
  const Space smooth = space({9, 4, PoleRule::c1}), plain = space({9, 4, PoleRule::plain});
  const Net net = random_net(smooth.n_points, 11);
  const double coarse = spread_of_normals(smooth, net, 9, 1e-3), fine = spread_of_normals(smooth, net, 9, 1e-5);
  EXPECT_LT(coarse, 0.2);
  EXPECT_NEAR(coarse / fine, 100, 5);
  EXPECT_GT(spread_of_normals(plain, random_net(plain.n_points, 11), 9, 1e-5), 0.5);
  // The normal at the pole is the normal of the control triangle.
  const Basis b = basis(smooth.elements[0], 0.35, 1e-7, 1);
  const Eigen::MatrixXd P = net_of(smooth.elements[0], net);
  const Vec3 a1 = (b.s.transpose() * P).transpose(), a2 = (b.t.transpose() * P).transpose();
  const Vec3 T0 = net.row(0).transpose(), T1 = net.row(1).transpose(), T2 = net.row(2).transpose();
  EXPECT_LT(a1.cross(a2).normalized().cross((T1 - T0).cross(T2 - T0).normalized()).norm(), 1e-5);
}

TEST(Polar, TransformedElementsAgreeAlongAllTheirSides) {
  // The surface has no gaps if every value on a side is also a value on the side of another element.
  const Space s = space({5, 4, PoleRule::bezier_transform, 1});
  const Net net = random_net(s.n_points, 2);
  std::vector<Vec3> points;
  for (std::size_t e = 0; e < s.elements.size(); ++e)
    for (const double x : {0.0, 0.5, 1.0})
      for (const auto& [a, b] : {std::array{x, 0.0}, {1.0, x}, {x, 1.0}, {0.0, x}}) points.push_back(value_at(s, net, {int(e), a, b}));
  // Counts the points that no other element has. The base sides of the pieces are parts of the sides of the tensor grid, so their middles have no
  // partner.
  int lonely = 0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    int others = 0;
    for (std::size_t q = 0; q < points.size(); ++q) others += q / 12 != p / 12 && (points[p] - points[q]).norm() < 1e-12;
    lonely += others == 0;
  }
  EXPECT_EQ(lonely, 2 * 5 * 4);  // middles of the four parts of each base side, because the side of the tensor grid is not divided
}

TEST(PolarSites, AllSitesOfAPointSeeTheSameField) {
  for (const PoleRule rule : every_rule) {
    const int m = 10, r = 6;
    const Space s = space({m, r, rule});
    const Net net = random_net(s.n_points, 11);
    for (const auto& sites : s.collocation) {
      const Vec3 first = value_at(s, net, sites[0]);
      for (const Site& site : sites) EXPECT_LT((value_at(s, net, site) - first).norm(), 1e-12);
    }
    if (rule == PoleRule::c1) continue;
    EXPECT_EQ(int(s.collocation.front().size()), rule == PoleRule::plain ? m : 4 * m);
    EXPECT_EQ(int(s.collocation.back().size()), rule == PoleRule::plain ? m : 4 * m);
    const std::set<std::size_t> around{s.collocation[1 + 2 * m].size(), s.collocation[1 + 3 * m].size()};
    EXPECT_EQ(around, std::set<std::size_t>{4});
  }
}

TEST(PolarSites, CollocationIsWellConditioned) {
  for (const PoleRule rule : every_rule) {
    for (const auto& [m, r] : {std::array{8, 4}, {16, 8}, {20, 10}}) {
      EXPECT_LT(condition_number(collocation_matrix(space({m, r, rule}))), 17);  // 13.6 to 15.8 with one point per pole, 8.2 to 9.4 with three
    }
  }
}

}  // namespace
}  // namespace tanktread::spline
