// The rigid surface: tractions, forces and the null space, compared with exact solutions.

#include <cmath>
#include <functional>
#include <memory>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "spline/extraction.hpp"
#include "spline/t_mesh.hpp"
#include "stokes/flow/ellipsoid.hpp"
#include "surface/geometry.hpp"
#include "surface/shapes.hpp"
#include "system/solids/resistance.hpp"

namespace tanktread::coupling {
namespace resistance_test {

using std::numbers::pi;
constexpr double viscosity = 1.7;

/// A rigid body on the cube mesh of six elements per side. The fitted surface has errors of 1e-5 in position and 1e-4 in the normal.
struct Fixture {
  spline::TMesh mesh = spline::cube(6);
  spline::Space space = spline::space(mesh, spline::ExtraordinaryRule::g1);
  surface::ParticleShape shape;
  Net surface;
  SolverOptions solvers;
  Ranks ranks;
  Phases phases;
  std::unique_ptr<Resistance> body;

  explicit Fixture(const Vec3& semi_axes) {
    shape.shape = "ellipsoid";
    shape.semi_axes = semi_axes;
    surface = surface::initial_shape(space, mesh, shape);
    solvers.tolerance = 1e-12;  // symmetry and balance hold up to the residual of the solve
    quadrature::Options quadrature;
    quadrature.tolerance = 1e-7;
    body = std::make_unique<Resistance>(space, surface, viscosity, quadrature, solvers, ranks, phases);
  }

  /// Returns the control values of an affine velocity field. They equal the values of the field at the control points, because the basis sums to one.
  Net field(const std::function<Vec3(const Vec3&)>& velocity) const {
    Net u(surface.rows(), 3);
    for (Eigen::Index a = 0; a < u.rows(); ++a) u.row(a) = velocity(surface.row(a).transpose()).transpose();
    return u;
  }

  /// Returns the largest difference between a density and an exact density over the collocation sites, relative to `scale`.
  double difference(const Net& f, const std::function<Vec3(const Vec3& x, const Vec3& n)>& exact, double scale) const {
    double largest = 0;
    for (const auto& sites : space.collocation) {
      const surface::Point p = surface::point(space, surface, sites.front());
      largest = std::max(largest, (surface::value(space, f, sites.front()) - exact(p.x, p.n)).norm() / scale);
    }
    return largest;
  }
};

Fixture sphere() { return Fixture(Vec3::Constant(0.8)); }

Fixture spheroid() { return Fixture(Vec3(0.7, 0.7, 1.1)); }

TEST(Resistance, OfASphereIsStokes) {
  const Fixture s = sphere();
  const double a = 0.8;
  const Vec3 u(1, -2, 0.5);
  const Net f = s.body->force_density(s.field([&](const Vec3&) { return u; }));
  const Vec3 exact = 6 * pi * viscosity * a * u;
  EXPECT_LT((s.body->force(f) - exact).norm() / exact.norm(), 1.5e-5);  // fourth order: 8e-6
  const Vec3 density = 3 * viscosity * u / (2 * a);
  EXPECT_LT(s.difference(f, [&](const Vec3&, const Vec3&) { return density; }, density.norm()), 3e-3);  // error of the normal
  EXPECT_LT(s.body->torque(f, Vec3::Zero()).norm() / exact.norm(), 1e-9);                               // the mesh is symmetric
}

TEST(Resistance, OfATurningSphereIsATorque) {
  const Fixture s = sphere();
  const double a = 0.8;
  const Vec3 omega(0.3, 1, -0.7);
  const Net f = s.body->force_density(s.field([&](const Vec3& x) -> Vec3 { return omega.cross(x); }));
  const Vec3 exact = 8 * pi * viscosity * a * a * a * omega;
  EXPECT_LT((s.body->torque(f, Vec3::Zero()) - exact).norm() / exact.norm(), 5e-5);  // fourth order: 2.5e-5
  EXPECT_LT(s.body->force(f).norm() / exact.norm(), 1e-9);                           // the mesh is symmetric
}

TEST(Resistance, OfAStrainedSphereIsFiveTimesTheStrain) {
  const Fixture s = sphere();
  Mat3 strain;
  strain << 1, 0.4, -0.3, 0.4, -0.2, 0.6, -0.3, 0.6, -0.8;
  const Net f = s.body->force_density(s.field([&](const Vec3& x) -> Vec3 { return strain * x; }));
  EXPECT_LT(s.difference(f, [&](const Vec3&, const Vec3& n) -> Vec3 { return 5 * viscosity * strain * n; }, 5 * viscosity), 5e-3);
  const Mat3 exact = 20 * pi / 3 * viscosity * 0.8 * 0.8 * 0.8 * strain;
  EXPECT_LT((s.body->stresslet(f, Vec3::Zero()) - exact).norm() / exact.norm(), 5e-5);  // fourth order: 2.4e-5
}

TEST(Resistance, OfASpheroidIsOberbecks) {
  const Fixture s = spheroid();
  const stokes::Ellipsoid exact(Vec3(0.7, 0.7, 1.1));
  const Vec3 u(0.6, 0.1, 0.8), omega(0.5, -0.2, 0.9);
  const Net f = s.body->force_density(s.field([&](const Vec3& x) -> Vec3 { return u + omega.cross(x); }));
  const Vec3 force = exact.force(viscosity, u), torque = exact.torque(viscosity, omega);
  EXPECT_LT((s.body->force(f) - force).norm() / force.norm(), 1.5e-5);                   // fourth order: 8e-6
  EXPECT_LT((s.body->torque(f, Vec3::Zero()) - torque).norm() / torque.norm(), 5e-5);  // 2.5e-5
  const auto density = [&](const Vec3& x, const Vec3&) { return exact.force_density(viscosity, u, omega, x); };
  EXPECT_LT(s.difference(f, density, density(Vec3(0.7, 0, 0), {}).norm()), 5e-3);
}

TEST(Resistance, LacksWhatTheReciprocalTheoremGives) {
  const Fixture s = spheroid();
  const stokes::Ellipsoid exact(Vec3(0.7, 0.7, 1.1));
  const Vec3 u(0.6, 0.1, 0.8);
  const Net velocity = s.field([&](const Vec3&) { return u; }), f = s.body->force_density(velocity);
  std::vector<Net> z;
  for (int k = 0; k < 3; ++k) z.push_back(s.body->force_density(s.field([&](const Vec3&) -> Vec3 { return Vec3::Unit(k); })));
  const Vec3 force = exact.force(viscosity, u);
  const double plain = (s.body->force(f) - force).norm() / force.norm();
  const auto uniform = [&](const Net& x) -> Net { return u.transpose().replicate(x.rows(), 1); };
  const double corrected = (s.body->force(f) + s.body->residual_work(uniform, f, z) - force).norm() / force.norm();
  EXPECT_LT(corrected, 2e-7);  // relative volume error of the fitted surface: 2e-7
  EXPECT_LT(corrected, plain / 20);
}

TEST(Resistance, KnowsNothingOfAUniformPressure) {
  const Fixture s = spheroid();
  const Net u = s.field([](const Vec3& x) -> Vec3 { return Vec3(1, 0, 0) + Vec3(0, 0, 1).cross(x); });
  const Net f = s.body->force_density(u);
  // The condition int f.n dG = 0 is a choice. Adding a multiple of n to f changes neither force nor torque.
  const Net b = surface::Geometry(s.space).volume_gradient(s.surface);
  EXPECT_LT(std::abs(b.cwiseProduct(f).sum()), 1e-10 * b.norm() * f.norm());  // the residual is 1e-12
  const Net n = s.body->normal();
  EXPECT_LT((s.body->force(f + 100 * n) - s.body->force(f)).norm(), 1e-10 * s.body->force(f).norm());  // int n dG = 0 holds to round-off
  EXPECT_LT((s.body->torque(f + 100 * n, Vec3::Zero()) - s.body->torque(f, Vec3::Zero())).norm(), 1e-3);  // int x x N_A n_A dG: error of the fitted n
}

TEST(Resistance, TakesUpTheFluxThatNoFluidCanCarry) {
  const Fixture s = sphere();
  // The density f of a growing body equals that of a body at rest, up to the pressure inside.
  const Net f = s.body->force_density(s.field([](const Vec3& x) { return x; }));
  EXPECT_LT(s.body->force(f).norm(), 1e-9);
  EXPECT_LT(s.body->stresslet(f, Vec3::Zero()).norm(), 1e-3);
}

TEST(Resistance, MatrixIsSymmetric) {
  // Six rigid motions of an ellipsoid in its principal axes about a point other than its centre: a full matrix.
  Fixture s(Vec3(0.7, 0.9, 1.1));
  const Vec3 about(0.3, -0.2, 0.4);
  Eigen::Matrix<double, 6, 6> matrix;
  for (int k = 0; k < 3; ++k) {
    const Net push = s.body->force_density(s.field([&](const Vec3&) -> Vec3 { return Vec3::Unit(k); }));
    const Net turn = s.body->force_density(s.field([&](const Vec3& x) -> Vec3 { return Vec3::Unit(k).cross(x - about); }));
    matrix.col(k) << s.body->force(push), s.body->torque(push, about);
    matrix.col(3 + k) << s.body->force(turn), s.body->torque(turn, about);
  }
  EXPECT_LT((matrix - matrix.transpose()).norm() / matrix.norm(), 1e-5);  // collocation is not symmetric; error of the fitted surface
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues().minCoeff(), 0);
}

TEST(Resistance, SaysWhenTheSolverStopsShort) {
  Fixture s(Vec3(0.7, 0.7, 1.1));
  s.solvers.tolerance = 1e-30;
  Resistance short_of_it(s.space, s.surface, viscosity, {}, s.solvers, s.ranks, s.phases);
  EXPECT_THROW(short_of_it.force_density(s.field([](const Vec3&) { return Vec3(1, 0, 0); })), RunFailure);
}

}  // namespace resistance_test
}  // namespace tanktread::coupling
