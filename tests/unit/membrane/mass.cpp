#include "membrane/mass.hpp"

#include <gtest/gtest.h>
#include <Eigen/SparseCholesky>

#include "capsules.hpp"
#include "membrane/direct_solver.hpp"
#include "membrane/membrane.hpp"
#include "surface/geometry.hpp"

namespace tanktread::membrane {
namespace {

TEST(MassMatrix, SumsToTheAreaOfTheSurface) {
  const Sphere& s = sphere(4);
  const Net x = deformed(s.net);
  for (int order : {3, 4, 5}) {
    MassMatrix mass(s.space, order);
    const double area = energy(Membrane(s.space, s.net, SurfaceTension{1}, order), x);  // with the same Gauss points
    EXPECT_NEAR(mass.update(x).sum(), area, 1e-13 * area);                             // round-off
  }
  EXPECT_NEAR(MassMatrix(s.space, 8).update(x).sum(), surface::measures(s.space, x).area, 1e-5);  // quadrature error of the latter
}

TEST(MassMatrix, IntegratesProductsOfFields) {
  const Sphere& s = sphere(4);
  MassMatrix mass(s.space, 6);
  const Eigen::MatrixXd moments = s.net.transpose() * (mass.update(s.net) * s.net);  // int x x^T dGamma = 4 pi / 3 on the unit sphere
  EXPECT_LT((moments - 4 * M_PI / 3 * Eigen::Matrix3d::Identity()).norm(), 1e-3);    // error of the fit of the sphere, about h^4
}

TEST(MassMatrix, IsSymmetricPositiveDefiniteAndRefillsInPlace) {
  const Sphere& s = sphere(4);
  MassMatrix mass(s.space);
  const Eigen::SparseMatrix<double> first = mass.update(s.net), transposed = first.transpose();
  EXPECT_EQ((first - transposed).norm(), 0);
  EXPECT_EQ(Eigen::SimplicialLLT<Eigen::SparseMatrix<double>>(first).info(), Eigen::Success);
  mass.update(deformed(s.net));
  EXPECT_EQ((mass.update(s.net) - first).norm(), 0);
}

TEST(MassMatrix, HasItsRowSumsWithoutTheMatrixAndIsTheSameAfterItsRelease) {
  const Sphere& s = sphere(4);
  const Net x = deformed(s.net);
  MassMatrix mass(s.space);
  const Eigen::VectorXd without = mass.row_sums(x);
  const Eigen::SparseMatrix<double> first = mass.update(x);
  EXPECT_LT((without - first * Eigen::VectorXd::Ones(x.rows())).norm(), 1e-14 * without.norm());  // round-off
  mass.release();
  EXPECT_EQ((mass.update(x) - first).norm(), 0);
}

/// Returns the L2 error of the traction from S f = d, relative to the closed form 2 T/R n, for a sphere inflated by 1.2.
double traction_error(int n, const Law& law) {
  const Sphere& s = sphere(n);
  const double stretch = 1.2, pressure = 2 * principal_tensions(law, stretch, stretch)[0] / stretch;
  const Net x = stretch * s.net;
  MassMatrix mass(s.space, 6);
  DirectSolver solver;
  solver.factor(mass.update(x));
  const Net error = solver.solve(Membrane(s.space, s.net, law, 6).load(x)) - pressure * s.net;  // n = x/R is a spline up to the fit error
  return std::sqrt(inner(error, mass.update(x) * error) / (4 * M_PI * stretch * stretch)) / pressure;
}

TEST(Load, OfAnInflatedSphereConvergesToTheClosedForm) {
  for (const Law& law : {Law(NeoHookean{1}), Law(Skalak{1, 2}), Law(SurfaceTension{1})}) {
    const double e3 = traction_error(3, law), e6 = traction_error(6, law), e12 = traction_error(12, law);
    EXPECT_LT(e12, 2e-4);                   // 9e-5 measured
    EXPECT_GT(std::log2(e3 / e12) / 2, 2);  // mean order over all three meshes
    EXPECT_GT(std::log2(e6 / e12), 1);      // lower order on the finest mesh because of the extraordinary points
  }
}

}  // namespace
}  // namespace tanktread::membrane
