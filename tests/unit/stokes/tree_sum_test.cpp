#include "stokes/sums/tree_sum.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include "spline/extraction.hpp"
#include "surface/shapes.hpp"
#include "tests/layers.hpp"

namespace tanktread::stokes {
namespace tree_sum_test {

/// Nodes with forces, in small groups, and targets.
struct Cloud {
  std::vector<double> x[3], f[3];
  std::vector<int> starts{0};
  std::vector<Vec3> targets;

  /// `flatness` shrinks the cube of side 2 along its diagonal. A few targets coincide with nodes.
  Cloud(int nodes, int n_targets, double flatness) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> side(-1, 1);
    const auto place = [&] {
      const Vec3 p(side(random), side(random), side(random)), diagonal = Vec3::Ones() / std::sqrt(3.);
      return Vec3(p - (1 - flatness) * p.dot(diagonal) * diagonal);
    };
    Vec3 group = place();
    for (int k = 0; k < nodes; ++k) {
      const Vec3 at = group + 0.02 * flatness * place();
      for (int c = 0; c < 3; ++c) x[c].push_back(at[c]), f[c].push_back(side(random));
      if (k % 4 == 3 || k % 7 == 0 || k + 1 == nodes) starts.push_back(k + 1), group = place();
    }
    for (int i = 0; i < n_targets; ++i) targets.push_back(i % 100 ? place() : Vec3(x[0][i], x[1][i], x[2][i]));
  }

  Net sum(TreeSum& tree, const std::vector<int>& wanted) const {
    Net u = Net::Zero(static_cast<Eigen::Index>(targets.size()), 3);
    tree.set_sources(x, starts, targets);
    tree.want(wanted);
    tree.sum<StokesletKernel>({f[0].data(), f[1].data(), f[2].data()}, u.data());
    return u;
  }

  /// Returns the largest error of the wanted rows, relative to sum |f| / r at each target.
  double error(const Net& u, const std::vector<int>& wanted) const {
    double largest = 0;
    for (const int i : wanted) {
      Vec3 exact;
      node_sum(charges(x, f), targets[i].data(), exact.data());
      double size = 0;
      for (std::size_t k = 0; k < x[0].size(); ++k) {
        const double r = (Vec3(x[0][k], x[1][k], x[2][k]) - targets[i]).norm();
        if (r > 0) size += Vec3(f[0][k], f[1][k], f[2][k]).norm() / r;
      }
      largest = std::max(largest, (u.row(i).transpose() - exact).norm() / size);
    }
    return largest;
  }
};

std::vector<int> every(int step, std::size_t n) {
  std::vector<int> rows;
  for (int i = 0; i < static_cast<int>(n); i += step) rows.push_back(i);
  return rows;
}

TEST(TreeSum, KeepsItsToleranceInACubeAndInATiltedSlab) {
  struct Case {
    double flatness, tolerance;
  };
  for (const auto& [flatness, tolerance] : {Case{1, 1e-3}, {1, 1e-5}, {0.01, 1e-3}, {0.01, 1e-5}, {0.01, 1e-8}}) {
    const Cloud cloud(20000, 3001, flatness);
    TreeSum tree(tolerance);
    const double error = cloud.error(cloud.sum(tree, every(1, cloud.targets.size())), every(50, cloud.targets.size()));
    EXPECT_LT(error, tolerance) << flatness;
    EXPECT_GT(error, 1e-14) << flatness;                          // clusters were used
    EXPECT_LT(tree.interactions(), 20000ll * 3001) << tolerance;  // and saved work
  }
}

TEST(Clusters, HaveNodesOnlyWhereTheseAreFewerThanTheirPoints) {
  const Cloud cloud(9000, 0, 1);
  Clusters tree(1e-5, 64, 1);
  tree.set_sources(cloud.x, cloud.starts);
  int nodes = 0, bare = 0;
  for (const Cluster& c : tree.all()) {
    EXPECT_EQ(c.bare, c.n_points() <= c.n_nodes());
    bare += c.bare;
    if (!c.bare) nodes += c.n_nodes();
  }
  EXPECT_EQ(nodes, tree.n_nodes());
  EXPECT_GT(bare, 0);
  EXPECT_GT(nodes, 0);
}

// Rounding errors differ between ranks. They must not decide between equally good clusters, of which there are many in a scene with mirror planes.
TEST(Clusters, OfMirroredPointsDoNotDependOnRounding) {
  const Cloud half(2000, 0, 1);
  std::vector<double> x[3], moved[3];
  std::vector<int> starts{0};
  for (std::size_t k = 0; k < half.x[0].size(); ++k)
    for (const double side : {1., -1.})
      for (int c = 0; c < 3; ++c) x[c].push_back(c == 1 ? side * half.x[c][k] : half.x[c][k]);
  for (std::size_t k = 0; k < x[0].size(); ++k) {
    starts.push_back(static_cast<int>(k) + 1);
    for (int c = 0; c < 3; ++c) moved[c].push_back(x[c][k] + 1e-16 * std::sin(static_cast<double>(7 * k) + c));
  }
  Clusters tree(1e-5, 64, 1), other(1e-5, 64, 1);
  tree.set_sources(x, starts);
  other.set_sources(moved, starts);
  EXPECT_EQ(tree.order(), other.order());
}

TEST(TreeSum, RowsDoNotDependOnOtherRequestedRows) {
  const Cloud cloud(5000, 1000, 0.05);
  TreeSum tree(1e-5), other(1e-5);
  const Net whole = cloud.sum(tree, every(1, 1000));
  const std::vector<int> few = every(37, 1000);
  const Net part = cloud.sum(other, few), again = cloud.sum(tree, few);
  for (const int i : few) {
    EXPECT_EQ(part.row(i), whole.row(i));  // bitwise equal, because ranks compute different rows
    EXPECT_EQ(again.row(i), whole.row(i));
  }
}

TEST(TreeSum, AcceptsOnePointAndCoincidentPoints) {
  Cloud one(1, 1, 1);
  one.targets[0] = Vec3(3, 0, 0);
  TreeSum tree(1e-5);
  EXPECT_LT(one.error(one.sum(tree, {0}), {0}), 1e-14);  // round-off
  Cloud many(600, 40, 1);
  for (auto& component : many.x) std::fill(component.begin(), component.end(), 0.5);
  for (Vec3& target : many.targets) target = Vec3(2, 1, 0);
  EXPECT_LT(many.error(many.sum(tree, every(1, 40)), every(1, 40)), 1e-13);
}

TEST(TreeSum, PassesOnNan) {
  Cloud cloud(2000, 300, 0.1);
  for (int k = 0; k < 2000; k += 3) cloud.x[k % 2][k] = NAN;
  TreeSum tree(1e-5);
  EXPECT_FALSE(cloud.sum(tree, every(1, 300)).allFinite());  // the call must also return, because a diverging run passes such values
}

/// A deformed sphere with enough elements for clusters, and a field on it.
struct Surface {
  spline::Space space;
  Net x, field;
  std::vector<int> all;

  explicit Surface(int n = 12) {
    const spline::TMesh mesh = spline::cube(n);
    space = spline::space(mesh, spline::ExtraordinaryRule::g1);
    const surface::LeastSquaresFit fit(space);
    const Net sphere = surface::unit_sphere(mesh, fit);
    x = fit.fit_image(sphere, [](const Vec3& p) { return Vec3(1.3 * p[0] + 0.4 * p[2], 0.9 * p[1], 0.75 * p[2]); });
    field = fit.fit_image(sphere, [](const Vec3& p) { return Vec3(p[1] - 0.3, p[2] * p[0], p[0] * p[0]); });
    all = every(1, static_cast<std::size_t>(space.n_points));
  }
};

const Surface& surface_of_clusters() {
  static const Surface one;
  return one;
}

double difference(const Net& a, const Net& b) { return (a - b).rowwise().norm().maxCoeff() / b.rowwise().norm().maxCoeff(); }

TEST(TreeSum, ComputesTheSingleLayerOfALoadToTheTolerance) {
  const auto& [space, x, f, all] = surface_of_clusters();
  for (const double tolerance : {1e-3, 1e-5, 1e-8}) {
    SingleLayer tree(space, {.tolerance = tolerance, .far_sum = "tree"}), dense(space, {.tolerance = tolerance, .far_sum = "dense"});
    Net u = Net::Zero(space.n_points, 3), exact = u;
    tree.apply(x, f, Measure::current, all, u);
    dense.apply(x, f, Measure::current, all, exact);
    EXPECT_LT(difference(u, exact), tolerance);
    EXPECT_GT(difference(u, exact), 1e-15);  // the sums differ
    EXPECT_LT(tree.evaluations().far, dense.evaluations().far);
  }
}

TEST(TreeSum, ComputesTheSingleLayerOfASymmetricLoadFromAPartOfTheSurface) {
  for (const int n : {6, 7}) {  // with 7, some panels are images of themselves
    auto [space, x, f, all] = Surface(n);
    const Net* nets[] = {&x};
    const surface::Symmetry symmetry = surface::symmetry(space, nets, [](const surface::Image&) { return true; });
    ASSERT_EQ(symmetry.order(), 4);
    symmetry.complete(f);
    for (const double tolerance : {1e-3, 1e-8}) {
      SingleLayer part(space, {.tolerance = tolerance, .far_sum = "tree"}), dense(space, {.tolerance = tolerance, .far_sum = "dense"});
      part.set_symmetry(symmetry);
      Net u = Net::Zero(space.n_points, 3), exact = u;
      part.apply(x, f, Measure::current, symmetry.fundamental(), u);
      symmetry.complete(u);
      dense.apply(x, f, Measure::current, all, exact);
      EXPECT_LT(difference(u, exact), tolerance);
    }
  }
}

TEST(TreeSum, PartsOfTheSingleLayerAddUpAndHaveEqualWork) {
  const auto& [space, x, f, all] = surface_of_clusters();
  SingleLayer one(space, {.far_sum = "tree"});
  Net whole = Net::Zero(space.n_points, 3), sum = whole;
  one.apply(x, f, Measure::current, all, whole);
  for (int part = 0; part < 3; ++part) {
    SingleLayer layer(space, {.far_sum = "tree"});
    layer.share(part, 3, all);
    std::vector<int> mine;
    for (int i = part; i < space.n_points; i += 3) mine.push_back(i);
    Net u = Net::Zero(space.n_points, 3);
    layer.apply(x, f, Measure::current, mine, u);
    const auto all_parts = static_cast<double>(one.evaluations().far);
    EXPECT_NEAR(3 * static_cast<double>(layer.evaluations().far), all_parts, 0.02 * all_parts);
    sum += u;
  }
  EXPECT_LT(difference(sum, whole), 1e-13);  // round-off
}

TEST(TreeSum, ComputesTheDoubleLayerOfAVelocityToTheTolerance) {
  const auto& [space, x, v, all] = surface_of_clusters();
  for (const double tolerance : {1e-3, 1e-5, 1e-8}) {
    DoubleLayer tree(space, {.tolerance = tolerance, .far_sum = "tree"}), dense(space, {.tolerance = tolerance, .far_sum = "dense"});
    Net u = Net::Zero(space.n_points, 3), exact = u, again = u;
    tree.apply(x, v, all, u);
    dense.apply(x, v, all, exact);
    EXPECT_LT(difference(u, exact), tolerance);
    EXPECT_GT(difference(u, exact), 1e-15);
    tree.apply(0.5 * x, v, all, again);
    tree.apply(x, v, all, again);
    EXPECT_EQ(again, u);  // no data of another shape are kept
  }
}

TEST(TreeSum, PartsOfTheDoubleLayerAddUpAndHaveEqualWork) {
  const auto& [space, x, v, all] = surface_of_clusters();
  DoubleLayer one(space, {.far_sum = "tree"});
  Net whole = Net::Zero(space.n_points, 3), sum = whole;
  one.apply(x, v, all, whole);
  for (int part = 0; part < 3; ++part) {
    DoubleLayer layer(space, {.far_sum = "tree"});
    layer.share(part, 3, all);
    std::vector<int> mine;
    for (int i = part; i < space.n_points; i += 3) mine.push_back(i);
    Net u = Net::Zero(space.n_points, 3);
    layer.apply(x, v, mine, u);
    const auto all_parts = static_cast<double>(one.evaluations().far);
    EXPECT_NEAR(3 * static_cast<double>(layer.evaluations().far), all_parts, 0.02 * all_parts);
    sum += u;
  }
  EXPECT_LT(difference(sum, whole), 1e-13);  // round-off
}

TEST(TreeSum, DoubleLayerOfATranslationVanishes) {
  const auto& [space, x, v, all] = surface_of_clusters();
  DoubleLayer layer(space, {.far_sum = "tree"});
  Net u = Net::Zero(space.n_points, 3);
  layer.apply(x, Net::Ones(space.n_points, 3), all, u);
  EXPECT_LT(u.cwiseAbs().maxCoeff(), 1e-12);  // round-off
}

TEST(TreeSum, IsChosenForLargeSurfacesOnly) {
  const auto chosen = [](int n, const quadrature::Options& options) {
    return sums_by_tree(spline::space(spline::cube(n), spline::ExtraordinaryRule::g1), options);
  };
  EXPECT_FALSE(chosen(6, {}));
  EXPECT_TRUE(chosen(24, {}));
  EXPECT_TRUE(chosen(6, {.far_sum = "tree"}));
  EXPECT_FALSE(chosen(24, {.far_sum = "dense"}));
  EXPECT_FALSE(chosen(24, {.rule = quadrature::LayerRule::desingularised}));  // its identities sum over every node
}

}  // namespace tree_sum_test
}  // namespace tanktread::stokes
