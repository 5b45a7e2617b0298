// The resistance problem of the paper's section 4.1 compared with the exact solution (Oberbeck 1876): orders of convergence in the element size, and
// errors. Quadrature has the tolerance 1e-8 and the solver 1e-10, as in the decks, so the remaining error is that of the mesh.

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "quadrature/gauss.hpp"
#include "scene/exact_body.hpp"
#include "tests/rigid.hpp"

namespace tanktread {
namespace rigid_spheroid_test {

RigidSolution on_cube(int n, std::vector<std::string> settings = {}) {
  settings.push_back("Surface/elements per side=" + std::to_string(n));
  return rigid_solution("spheroid_cube.yaml", settings);
}

RigidSolution with_poles(const std::string& poles, int meridional) {
  return rigid_solution("spheroid_polar.yaml", {"Surface/poles=" + poles, "Surface/meridional elements=" + std::to_string(meridional),
                                                "Surface/azimuthal elements=" + std::to_string(2 * meridional)});
}

double order(double coarse, double fine) { return std::log2(coarse / fine); }

TEST(RigidSpheroid, ConvergesOnTheCubeMesh) {
  const RigidSolution coarse = on_cube(3), fine = on_cube(6);
  // Because of the extraordinary points, the orders of normal and pressure are below 3, the order of the space.
  EXPECT_GE(order(coarse.surface.normal, fine.surface.normal), 2.6);
  EXPECT_GE(order(coarse.surface.pressure, fine.surface.pressure), 2.9);
  EXPECT_GE(order(coarse.integral_error, fine.integral_error), 3.7);
  EXPECT_GE(order(coarse.error, fine.error), 5);
  EXPECT_LT(fine.surface.normal, 7e-4);
  EXPECT_LT(fine.surface.pressure, 8e-4);
  EXPECT_LT(fine.integral_error, 1e-5);
  EXPECT_LT(fine.error, 1e-7);
  EXPECT_LT(fine.iterations, 35);
}

TEST(RigidSpheroid, HasSevenDigitsOfItsDragAt866ControlPoints) {
  const RigidSolution coarse = on_cube(6), fine = on_cube(12);
  EXPECT_GE(order(coarse.surface.normal, fine.surface.normal), 2.6);
  EXPECT_GE(order(coarse.surface.pressure, fine.surface.pressure), 2.7);
  EXPECT_GE(order(coarse.integral_error, fine.integral_error), 3.8);
  EXPECT_GE(order(coarse.error, fine.error), 4.5);
  EXPECT_LT(fine.error, 5e-9);
}

TEST(RigidSpheroid, ConvergesOnTheStructuredMesh) {
  for (const char* poles : {"plain", "c1"}) {
    const RigidSolution coarse = with_poles(poles, 4), fine = with_poles(poles, 8);
    EXPECT_GE(order(coarse.surface.normal, fine.surface.normal), 3) << poles;
    EXPECT_GE(order(coarse.surface.pressure, fine.surface.pressure), 3) << poles;
    EXPECT_GE(order(coarse.error, fine.error), 6) << poles;
    EXPECT_LT(fine.surface.normal, 5e-4) << poles;
    EXPECT_LT(fine.surface.pressure, 5e-4) << poles;
    EXPECT_LT(fine.error, 3e-7) << poles;
  }
}

TEST(RigidSpheroid, HasTheExactTorque) {
  const RigidSolution s = on_cube(6, {"Particle/velocity=[0, 0, 0]", "Particle/angular velocity=[0.3, -1, 0.5]", "Particle/center=[1, 2, -3]",
                                      "Particle/orientation=[20, 0, 40]"});
  EXPECT_LT(s.torque_error, 3e-7);  // three times the error of the drag, because the torque grows with the cube of the size
  EXPECT_LT(s.surface.pressure, 3e-3);
  EXPECT_LT(s.force.norm(), 1e-7);  // zero by symmetry
}

TEST(RigidSpheroid, DependsOnlyOnItsMotionRelativeToTheFlow) {
  const RigidSolution moving = on_cube(3);
  const RigidSolution held =
      on_cube(3, {"Flow/type=uniform", "Flow/velocity=[0.7071067811865476, 0, 0.7071067811865476]", "Particle/velocity=[0, 0, 0]"});
  EXPECT_LT((moving.force - held.force).norm() / held.force.norm(), 1e-9);  // tolerance of the solver
  EXPECT_NEAR(moving.error, held.error, 1e-9);
}

/// Returns the force and torque that the flow v_inf of the deck exerts on an ellipsoid held at rest, by the reciprocal theorem: component k is the
/// integral of z.v_inf, where z is the force density on the ellipsoid when it translates along axis k (torque: rotates about axis k) at unit rate.
/// For h = x.n, z/h is a polynomial in x, and h dGamma = abc dOmega with the solid angle Omega of the unit sphere. The Gauss rule therefore
/// integrates a polynomial v_inf exactly. For a sphere the result is Faxen's law.
std::pair<Vec3, Vec3> on_a_held_ellipsoid(const Vec3& semi_axes, const std::vector<std::string>& settings) {
  Scene scene;
  deck::Document deck = deck::read({SOURCE_DIRECTORY "/inputs/spheroid_cube.yaml"}, settings);
  deck.declare(scene);
  const stokes::AmbientFlow flow(scene.flow);
  const surface::ParticleShape& shape = scene.particles.front().particle.shape;
  const Mat3 axes = shape.rotation();
  const stokes::Ellipsoid ellipsoid(semi_axes);
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  const quadrature::GaussRule& height = quadrature::gauss(4);
  constexpr int around = 8;
  for (int i = 0; i < height.size(); ++i)
    for (int j = 0; j < around; ++j) {
      const double z = 2 * height.nodes[i] - 1, angle = 2 * std::numbers::pi * j / around, r = std::sqrt(1 - z * z);
      const Vec3 x = semi_axes.cwiseProduct(Vec3(r * std::cos(angle), r * std::sin(angle), z));
      const double h = x.dot(ellipsoid.normal(x)), weight = 4 * std::numbers::pi / around * height.weights[i] * semi_axes.prod() / h;
      const Vec3 v = axes.transpose() * flow.velocity(shape.center + axes * x);
      for (int k = 0; k < 3; ++k) {
        force[k] += weight * v.dot(ellipsoid.force_density(scene.flow.viscosity, Vec3::Unit(k), Vec3::Zero(), x));
        torque[k] += weight * v.dot(ellipsoid.force_density(scene.flow.viscosity, Vec3::Zero(), Vec3::Unit(k), x));
      }
    }
  return {axes * force, axes * torque};
}

TEST(RigidBody, HeldInAParabolicFlowHasFaxensForce) {
  for (const Vec3& semi_axes : {Vec3(0.6, 0.6, 0.6), Vec3(0.5, 0.5, 0.75), Vec3(0.75, 0.5, 0.4)}) {
    const auto text = [](const Vec3& v) { return "[" + std::to_string(v[0]) + ", " + std::to_string(v[1]) + ", " + std::to_string(v[2]) + "]"; };
    const std::vector<std::string> settings = {"Flow/type=parabolic",          "Flow/half width=1.3",         "Particle/shape=ellipsoid",
                                               "Particle/velocity=[0, 0, 0]",  "Particle/semi-axes=" + text(semi_axes),
                                               "Particle/center=[1, 0.2, -0.3]", "Particle/orientation=[20, 0, 40]"};
    const auto [force, torque] = on_a_held_ellipsoid(semi_axes, settings);
    double of_force[2], of_torque[2];
    for (const int k : {0, 1}) {
      const RigidSolution s = on_cube(k ? 6 : 3, settings);
      of_force[k] = (s.force - force).norm() / force.norm(), of_torque[k] = (s.torque - torque).norm() / torque.norm();
    }
    std::printf("semi-axes %.2f %.2f %.2f: force off by %.1e, %.1e, order %.1f; torque by %.1e, %.1e, order %.1f\n", semi_axes[0], semi_axes[1],
                semi_axes[2], of_force[0], of_force[1], order(of_force[0], of_force[1]), of_torque[0], of_torque[1],
                order(of_torque[0], of_torque[1]));
    EXPECT_LT(of_force[1], 3e-7);
    EXPECT_LT(of_torque[1], 1e-6);
    EXPECT_GE(order(of_force[0], of_force[1]), 5);
  }
}

}  // namespace rigid_spheroid_test
}  // namespace tanktread
