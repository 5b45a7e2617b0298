// The resistance problem of the paper's section 4.1 against the exact solution (Oberbeck 1876): observed orders in the size of the elements, and
// the errors themselves. Quadrature 1e-8 and solver 1e-10, as the decks have them: what is left is the mesh.

#include <cmath>

#include <gtest/gtest.h>

#include "tests/rigid.hpp"

namespace tanktread {
namespace {

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
  // The extraordinary points hold the normal below the third order of the space, and the pressure with it.
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

TEST(RigidSpheroid, TurnsAgainstTheExactTorque) {
  const RigidSolution s = on_cube(6, {"Particle/velocity=[0, 0, 0]", "Particle/angular velocity=[0.3, -1, 0.5]", "Particle/center=[1, 2, -3]",
                                      "Particle/orientation=[20, 0, 40]"});
  EXPECT_LT(s.torque_error, 3e-7);  // three times that of the drag: as the cube of the size
  EXPECT_LT(s.surface.pressure, 3e-3);
  EXPECT_LT(s.force.norm(), 1e-7);  // symmetry
}

TEST(RigidSpheroid, FeelsOnlyItsMotionRelativeToTheFlow) {
  const RigidSolution moving = on_cube(3);
  const RigidSolution held =
      on_cube(3, {"Flow/type=uniform", "Flow/velocity=[0.7071067811865476, 0, 0.7071067811865476]", "Particle/velocity=[0, 0, 0]"});
  EXPECT_LT((moving.force - held.force).norm() / held.force.norm(), 1e-9);  // the solver's tolerance
  EXPECT_NEAR(moving.error, held.error, 1e-9);
}

}  // namespace
}  // namespace tanktread
