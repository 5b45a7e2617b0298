#include "record/files/nodes.hpp"

#include <set>

#include <gtest/gtest.h>

#include "patches.hpp"
#include "spline/extraction.hpp"

namespace tanktread::output {
namespace {

Vec3 sheet(double x, double y) { return {x, y, x * x * x * y * y - 2 * x * y * y * y + 1}; }
Vec3 sheet_normal(double x, double y) {
  return Vec3(-(3 * x * x * y * y - 2 * y * y * y), -(2 * x * x * x * y - 6 * x * y * y), 1).normalized();
}

/// Three adjacent patches of one bicubic sheet, of degrees 3, 3, 4.
struct Sheet {
  spline::Space space;
  Net net;
  Sheet() {
    for (int k = 0; k < 3; ++k) add_patch(space, net, k < 2 ? 3 : 4, [k](double s, double t) { return sheet(k + s, t); });
  }
};

TEST(LagrangeMesh, NeighboursOfOneDegreeShareTheNodesOfAnEdgeAndOthersItsCorners) {
  const Sheet sheet_;
  const LagrangeMesh mesh = lagrange_mesh(sheet_.space, sheet_.net);
  EXPECT_EQ(mesh.offsets, (std::vector<std::int64_t>{0, 16, 32, 57}));
  EXPECT_EQ(mesh.connectivity.size(), 57u);
  EXPECT_EQ(mesh.sites.size(), 57u - 4 - 2);
  const std::set<std::int64_t> used(mesh.connectivity.begin(), mesh.connectivity.end());
  EXPECT_EQ(used.size(), mesh.sites.size());
  EXPECT_EQ(*used.rbegin() + 1, static_cast<std::int64_t>(mesh.sites.size()));
}

TEST(LagrangeMesh, NodesAreInTheOrderOfVtk) {
  const Sheet sheet_;
  const LagrangeMesh mesh = lagrange_mesh(sheet_.space, sheet_.net);
  const std::vector<std::array<int, 2>> order{{0, 0}, {3, 0}, {3, 3}, {0, 3}, {1, 0}, {2, 0}, {3, 1}, {3, 2},
                                              {1, 3}, {2, 3}, {0, 1}, {0, 2}, {1, 1}, {2, 1}, {1, 2}, {2, 2}};
  const Eigen::MatrixXd points = Nodes(surface::BezierMap(sheet_.space), mesh).values(sheet_.net);
  for (int k = 0; k < 16; ++k) {
    EXPECT_NEAR(points(mesh.connectivity[k], 0), order[k][0] / 3., 1e-14);
    EXPECT_NEAR(points(mesh.connectivity[k], 1), order[k][1] / 3., 1e-14);
  }
}

TEST(LagrangeMesh, NodesLieOnTheSurfaceWithItsExactNormals) {
  const Sheet sheet_;
  const LagrangeMesh mesh = lagrange_mesh(sheet_.space, sheet_.net);
  const Eigen::MatrixXd points = Nodes(surface::BezierMap(sheet_.space), mesh).values(sheet_.net);
  const Net normals = Nodes(surface::BezierMap(sheet_.space), mesh).normals(sheet_.net);
  // The tolerances allow for round-off of the interpolation of heights up to 27.
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    EXPECT_NEAR((points.row(k).transpose() - sheet(points(k, 0), points(k, 1))).norm(), 0, 1e-12);
    EXPECT_NEAR((normals.row(k).transpose() - sheet_normal(points(k, 0), points(k, 1))).norm(), 0, 1e-11);
  }
}

TEST(LagrangeMesh, SitesAreTheElementsAndParametersOfTheNodes) {
  const Sheet sheet_;
  const LagrangeMesh mesh = lagrange_mesh(sheet_.space, sheet_.net);
  const Eigen::MatrixXd points = Nodes(surface::BezierMap(sheet_.space), mesh).values(sheet_.net);
  for (std::size_t k = 0; k < mesh.sites.size(); ++k)
    EXPECT_NEAR(points(static_cast<Eigen::Index>(k), 0), mesh.sites[k].element + mesh.sites[k].s, 1e-13);
}

TEST(LagrangeMesh, DerivativesAtTheNodesAreThoseOfTheElementThatTheirSitesName) {
  const Sheet sheet_;
  const Nodes nodes(surface::BezierMap(sheet_.space), lagrange_mesh(sheet_.space, sheet_.net));
  const Net moved = -2 * sheet_.net;
  std::size_t k = 0;
  nodes.each_node(sheet_.net, moved, [&](Eigen::Index node, const surface::Jet& before, const surface::Jet& now) {
    ASSERT_EQ(node, static_cast<Eigen::Index>(k));
    const auto& [element, s, t] = nodes.mesh().sites[k++];
    const surface::Jet there = surface::jet(surface::ElementPoints(sheet_.space, sheet_.net, element).patch(), s, t);
    for (const auto part : {&surface::Jet::x, &surface::Jet::s, &surface::Jet::t, &surface::Jet::ss, &surface::Jet::st, &surface::Jet::tt}) {
      EXPECT_LT((before.*part - there.*part).norm(), 1e-10);  // round-off of second derivatives of heights up to 27
      EXPECT_LT((now.*part + 2 * there.*part).norm(), 1e-10);
    }
  });
  EXPECT_EQ(k, nodes.mesh().sites.size());
}

TEST(LagrangeMesh, CoincidingSurfacesShareNoNodes) {
  const spline::Space one = spline::space(spline::cube(3), spline::ExtraordinaryRule::g1), both = spline::stacked(std::vector{&one, &one});
  const Net net = Net::Random(one.n_points, 3), twice = (Net(2 * net.rows(), 3) << net, net).finished();
  const LagrangeMesh single = lagrange_mesh(one, net, surfaces(one)), mesh = lagrange_mesh(both, twice, surfaces(both));
  EXPECT_EQ(single.sites.size(), lagrange_mesh(one, net).sites.size());
  EXPECT_EQ(mesh.sites.size(), 2 * single.sites.size());
}

TEST(LagrangeMesh, APoleIsOneNodeWithANormal) {
  spline::Space space;
  Net net;
  // The surface is a paraboloid x3 = -(x1^2 + x2^2) over a square, in two halves that are collapsed at t = 0 into the pole.
  for (const double side : {1., -1.}) {
    add_patch(space, net, 3, [side](double s, double t) {
      const double x = side * t, y = side * t * (2 * s - 1);
      return Vec3(x, y, -(x * x + y * y));
    });
  }
  const LagrangeMesh mesh = lagrange_mesh(space, net);
  EXPECT_EQ(mesh.sites.size(), 2u * 12 + 1);
  const Eigen::MatrixXd points = Nodes(surface::BezierMap(space), mesh).values(net);
  const Net normals = Nodes(surface::BezierMap(space), mesh).normals(net);
  for (Eigen::Index k = 0; k < points.rows(); ++k) {
    const Vec3 exact = -Vec3(2 * points(k, 0), 2 * points(k, 1), 1).normalized();
    // At the pole the normal is evaluated 1e-4 of the patch inside; the curvature is 2.
    EXPECT_NEAR((normals.row(k).transpose() - exact).norm(), 0, points.row(k).norm() < 1e-12 ? 5e-4 : 1e-12);
  }
}

}  // namespace
}  // namespace tanktread::output
