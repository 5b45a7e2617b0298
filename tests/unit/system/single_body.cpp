// Tests of one rigid surface: tractions, forces and the null space are compared with exact solutions.

#include <cmath>
#include <functional>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "single_ellipsoid.hpp"
#include "stokes/flow/ellipsoid.hpp"
#include "surface/geometry.hpp"

namespace tanktread::coupling {
namespace single_body_test {

using std::numbers::pi;
constexpr double viscosity = SingleEllipsoid::viscosity;

struct Fixture : SingleEllipsoid {
  explicit Fixture(const Vec3& semi_axes) : SingleEllipsoid(semi_axes, Vec3::Zero()) { place(Vec3::Zero()); }

  /// Sets the point about which torques and moments are computed.
  void place(const Vec3& centre) const { tractions->set_shape(rest, {&centre, 1}); }

  using Velocity = std::function<Vec3(const Vec3&)>;

  /// Returns the force density on the fluid for a velocity of the surface.
  Net density(const Velocity& velocity) const {
    Net at_sites = tractions->sites();
    for (auto row : at_sites.rowwise()) row = velocity(row.transpose()).transpose().eval();
    return tractions->density(at_sites);
  }

  SolvedBody integrals(const Net& f) const { return tractions->integrals(0, f); }

  /// Returns the largest difference between a density and an exact density over the collocation sites, relative to `scale`.
  double difference(const Net& f, const std::function<Vec3(const Vec3& x, const Vec3& n)>& exact, double scale) const {
    double largest = 0;
    for (const auto& sites : space.collocation) {
      const surface::Point p = surface::point(space, rest, sites.front());
      largest = std::max(largest, (surface::value(space, f, sites.front()) - exact(p.x, p.n)).norm() / scale);
    }
    return largest;
  }
};

Fixture sphere() { return Fixture(Vec3::Constant(0.8)); }

Fixture spheroid() { return Fixture(Vec3(0.7, 0.7, 1.1)); }

TEST(SingleBody, OfATranslatingSphereIsStokesDrag) {
  const Fixture s = sphere();
  const double a = 0.8;
  const Vec3 u(1, -2, 0.5);
  const Net f = s.density([&](const Vec3&) { return u; });
  const Vec3 exact = 6 * pi * viscosity * a * u;
  EXPECT_LT((s.integrals(f).force - exact).norm() / exact.norm(), 1.5e-5);  // fourth order: 8e-6
  const Vec3 density = 3 * viscosity * u / (2 * a);
  EXPECT_LT(s.difference(f, [&](const Vec3&, const Vec3&) { return density; }, density.norm()), 3e-3);  // error of the normal
  EXPECT_LT(s.integrals(f).torque.norm() / exact.norm(), 1e-9);                               // the mesh is symmetric
}

TEST(SingleBody, OfARotatingSphereIsItsTorque) {
  const Fixture s = sphere();
  const double a = 0.8;
  const Vec3 omega(0.3, 1, -0.7);
  const Net f = s.density([&](const Vec3& x) -> Vec3 { return omega.cross(x); });
  const Vec3 exact = 8 * pi * viscosity * a * a * a * omega;
  EXPECT_LT((s.integrals(f).torque - exact).norm() / exact.norm(), 5e-5);  // fourth order: 2.5e-5
  EXPECT_LT(s.integrals(f).force.norm() / exact.norm(), 1e-9);                           // the mesh is symmetric
}

TEST(SingleBody, OfAStrainedSphereIsFiveTimesTheStrain) {
  const Fixture s = sphere();
  Mat3 strain;
  strain << 1, 0.4, -0.3, 0.4, -0.2, 0.6, -0.3, 0.6, -0.8;
  const Net f = s.density([&](const Vec3& x) -> Vec3 { return strain * x; });
  EXPECT_LT(s.difference(f, [&](const Vec3&, const Vec3& n) -> Vec3 { return 5 * viscosity * strain * n; }, 5 * viscosity), 5e-3);
  const Mat3 exact = 20 * pi / 3 * viscosity * 0.8 * 0.8 * 0.8 * strain;
  EXPECT_LT((s.integrals(f).stresslet() - exact).norm() / exact.norm(), 5e-5);  // fourth order: 2.4e-5
}

TEST(SingleBody, OfASpheroidIsOberbecksDrag) {
  const Fixture s = spheroid();
  const stokes::Ellipsoid exact(Vec3(0.7, 0.7, 1.1));
  const Vec3 u(0.6, 0.1, 0.8), omega(0.5, -0.2, 0.9);
  const Net f = s.density([&](const Vec3& x) -> Vec3 { return u + omega.cross(x); });
  const Vec3 force = exact.force(viscosity, u), torque = exact.torque(viscosity, omega);
  EXPECT_LT((s.integrals(f).force - force).norm() / force.norm(), 1.5e-5);                   // fourth order: 8e-6
  EXPECT_LT((s.integrals(f).torque - torque).norm() / torque.norm(), 5e-5);  // 2.5e-5
  const auto density = [&](const Vec3& x, const Vec3&) { return exact.force_density(viscosity, u, omega, x); };
  EXPECT_LT(s.difference(f, density, density(Vec3(0.7, 0, 0), {}).norm()), 5e-3);
}

TEST(SingleBody, IsCorrectedByTheReciprocalTheorem) {
  const Fixture s = spheroid();
  const stokes::Ellipsoid exact(Vec3(0.7, 0.7, 1.1));
  const Vec3 u(0.6, 0.1, 0.8), centre = Vec3::Zero();
  const RigidDrive moving{true, {u, Vec3::Zero()}};
  stokes::FlowOptions at_rest;
  at_rest.type = "quiescent";
  s.tractions->solve(s.rest, {&centre, 1}, {&moving, 1}, stokes::AmbientFlow(at_rest));
  const Vec3 force = exact.force(viscosity, u);
  const double plain = (s.integrals(s.tractions->solution().unknowns).force - force).norm() / force.norm();
  const double corrected = (s.tractions->solution().bodies.front().force - force).norm() / force.norm();
  EXPECT_LT(corrected, 2e-7);  // relative volume error of the fitted surface: 2e-7
  EXPECT_LT(corrected, plain / 20);
}

TEST(SingleBody, IsIndependentOfAUniformPressure) {
  const Fixture s = spheroid();
  const Net f = s.density([](const Vec3& x) -> Vec3 { return Vec3(1, 0, 0) + Vec3(0, 0, 1).cross(x); });
  const Net b = surface::Geometry(s.space).volume_gradient(s.rest);
  EXPECT_LT(std::abs(b.cwiseProduct(f).sum()), 1e-10 * b.norm() * f.norm());  // the condition int f.n dGamma = 0 is a choice
}

TEST(SingleBody, AbsorbsANetFluxIntoThePressure) {
  const Fixture s = sphere();
  // The density f of a growing body equals that of a body at rest, up to the pressure inside.
  const Net f = s.density([](const Vec3& x) { return x; });
  EXPECT_LT(s.integrals(f).force.norm(), 1e-9);
  EXPECT_LT(s.integrals(f).stresslet().norm(), 1e-3);
}

TEST(SingleBody, MatrixIsSymmetric) {
  // Six rigid motions of an ellipsoid in its principal axes about a point other than its centre: a full matrix.
  Fixture s(Vec3(0.7, 0.9, 1.1));
  const Vec3 about(0.3, -0.2, 0.4);
  s.place(about);
  Eigen::Matrix<double, 6, 6> matrix;
  for (int k = 0; k < 3; ++k) {
    const Net push = s.density([&](const Vec3&) -> Vec3 { return Vec3::Unit(k); });
    const Net turn = s.density([&](const Vec3& x) -> Vec3 { return Vec3::Unit(k).cross(x - about); });
    matrix.col(k) << s.integrals(push).force, s.integrals(push).torque;
    matrix.col(3 + k) << s.integrals(turn).force, s.integrals(turn).torque;
  }
  EXPECT_LT((matrix - matrix.transpose()).norm() / matrix.norm(), 1e-5);  // collocation is not symmetric, and the fitted surface is not exact
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues().minCoeff(), 0);
}

}  // namespace single_body_test
}  // namespace tanktread::coupling
