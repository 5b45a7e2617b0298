// Tests of the frozen operator that has one quadrature node per control point.

#include <gtest/gtest.h>

#include "membrane/mass.hpp"
#include "spline/extraction.hpp"
#include "spline/t_mesh.hpp"
#include "surface/shapes.hpp"
#include "system/targets/collocation.hpp"
#include "system/frozen/nodal_operator.hpp"
#include "tests/layers.hpp"

namespace tanktread::coupling {
namespace nodal_operator_test {

struct Fixture {
  spline::TMesh mesh;
  spline::Space space = spline::space(mesh, spline::ExtraordinaryRule::g1);
  Net sphere = surface::resting_shape(space, mesh, {});
  Net x = sphere * Eigen::Vector3d(1.4, 0.9, 0.8).asDiagonal();
  stokes::SingleLayer layer{space, {}};
  std::vector<int> targets;
  std::string far_sum = "dense";

  explicit Fixture(int n = 6) : mesh(spline::cube(n)) {
    layer.set_reference(sphere);
    for (int i = 0; i < space.n_points; ++i) targets.push_back(i);
  }

  Net nodal(double reach, const Net& f, const std::vector<int>& own) {
    membrane::MassMatrix mass(space);
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(space.n_points);
    const Eigen::SparseMatrix<double> sites = collocation_matrix(space);
    const Eigen::VectorXd weights = mass.update(sphere) * ones, areas = mass.update(x) * ones;
    NodalOperator nodal;
    const NodalOperator::Surface surface{sites * x, sites, weights, areas, surface::Symmetry(space.n_points)};
    nodal.assemble(own, surface, reach, far_sum, [&](std::span<const int> some, const stokes::NearPoints& near, std::vector<double>& entries) {
      layer.assemble(x, stokes::Measure::reference, some, near, entries);
    });
    Net u = Net::Zero(space.n_points, 3);
    nodal.apply(f, u);
    return u;
  }

  /// Returns the relative error for a field with a few waves over the surface.
  double error(double reach) {
    Net f(space.n_points, 3), exact(space.n_points, 3);
    for (Eigen::Index i = 0; i < f.rows(); ++i)
      f.row(i) << std::sin(3 * sphere(i, 0)), sphere(i, 1) * sphere(i, 2), std::cos(2 * sphere(i, 1) + sphere(i, 0));
    layer.apply(x, f, stokes::Measure::reference, targets, exact);
    return (nodal(reach, f, targets) - exact).norm() / exact.norm();
  }
};

TEST(NodalOperator, IsTheSingleLayerToSinglePrecisionWhereEveryPointIsNear) {
  EXPECT_LT(Fixture().error(1e3), 3e-5);  // sum of 218 terms
}

TEST(NodalOperator, IsCloseToTheSingleLayerWhereAFewElementsAreNear) {
  EXPECT_LT(Fixture().error(3), 0.01);  // small compared with the error of the Jacobian itself, about a tenth
  EXPECT_GT(Fixture().error(0), 0.02);  // without any correction
}

TEST(NodalOperator, RowsDoNotDependOnOtherRequestedRows) {
  Fixture f;
  const Net force = Net::Random(f.space.n_points, 3), whole = f.nodal(3, force, f.targets), part = f.nodal(3, force, {3, 70, 111, 200, 217});
  for (const int i : {3, 70, 111, 200, 217}) EXPECT_EQ(part.row(i), whole.row(i));
  EXPECT_EQ(part.row(0), Net::Zero(1, 3));  // rows of other targets are unchanged
}

TEST(NodalOperator, WithClustersGivesNearlyTheSameResult) {
  Fixture f(12);  // more points than a leaf can hold
  const Net force = Net::Random(f.space.n_points, 3), dense = f.nodal(3, force, f.targets);
  f.far_sum = "tree";
  const Net clusters = f.nodal(3, force, f.targets), part = f.nodal(3, force, {3, 70, 111, 200, 217});
  EXPECT_LT((clusters - dense).norm() / dense.norm(), 1e-3);  // all rows computed
  EXPECT_GT((clusters - dense).norm(), 0);
  for (const int i : {3, 70, 111, 200, 217}) EXPECT_EQ(part.row(i), clusters.row(i));
}

}  // namespace nodal_operator_test
}  // namespace tanktread::coupling
