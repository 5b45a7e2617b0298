// Rigid sphere in a tube, compared with the exact solution on the axis, the asymptotic solution off it, and values on which other discretisations
// agree.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/verify/tube_scene.hpp"

namespace tanktread {
namespace tube_rigid_test {

using std::numbers::pi;

double error(double value, double exact) { return std::abs(value / exact - 1); }

/// Exact multipole solution on the axis: radius a divided by R_T; drags K1 (towed) and K2 (held, with the factor 2 V in front); speed of the free
/// sphere divided by the mean velocity; pressure drops in units of mu V/R_T.
struct Exact {
  double a, towed, held, speed, free_drop, held_drop;
};
constexpr Exact exact[] = {{0.2, 1.67947888, 1.63478639, 1.94677814, 0.00512283, 7.64328224},
                           {0.5, 5.94737425, 4.99533862, 1.67984674, 0.52183918, 50.87025904},
                           {0.8, 74.66996625, 47.62023481, 1.27548564, 7.73544560, 590.82913172}};

struct Tolerance {
  double drag, speed, drop;
};

void expect_exact(RigidSphere& sphere, const Exact& is, const Tolerance& within) {
  const RigidSphere::Resistance held = sphere.held();
  EXPECT_LT(error(sphere.towed().drag, is.towed), within.drag);
  EXPECT_LT(error(-held.drag / 2, is.held), within.drag);
  EXPECT_LT(error(held.pressure_drop, is.held_drop), within.drag);
  const coupling::State place = coupling::placed(Vec3::Zero());
  EXPECT_LT(error(sphere.body->motion(place).velocity[0], is.speed), within.speed);
  EXPECT_LT(error(sphere.body->pressure_drop(place), is.free_drop), within.drop);
}

TEST(RigidSphereInATube, OnTheAxisIsTheMultipoleSolution) {
  // With the default wall and 602 points on the sphere, the errors of the drags are 2e-6, 3e-6 and 1.6e-4, of which half is due to the sphere (order
  // 4).
  const Tolerance within[] = {{1e-5, 1e-6, 1e-4}, {1e-5, 1e-6, 1e-4}, {3e-4, 1e-4, 1e-4}};
  for (int k = 0; k < 3; ++k) {
    RigidSphere s(sphere(exact[k].a, Vec3::Zero(), 10), circular_duct());
    expect_exact(s, exact[k], within[k]);
  }
}

TEST(RigidSphereInATubeLong, IsTenTimesCloserOnAFinerWall) {
  RigidSphere s(polar_sphere(0.8, Vec3::Zero(), 32, 24), circular_duct(36, 34));
  expect_exact(s, exact[2], {3e-5, 1e-5, 1e-5});
}

TEST(RigidSphereInATube, DoesNotDependOnTheLengthOfTheTube) {
  const coupling::State place = coupling::placed(Vec3::Zero());
  for (const double a : {0.5, 0.8}) {
    const Sphere sphere = tanktread::sphere(a, Vec3::Zero(), 6);
    // the longer tube has no fewer elements around the sphere
    RigidSphere s(sphere, circular_duct()), longer(sphere, circular_duct(24, 40, 4 * pi));
    EXPECT_LT(error(longer.body->motion(place).velocity[0], s.body->motion(place).velocity[0]), 1e-5) << a;
    EXPECT_LT(error(longer.body->pressure_drop(place), s.body->pressure_drop(place)), 1e-5) << a;
  }
}

TEST(RigidSphereInATube, OffTheAxisMovesAsOnOtherMeshes) {
  // Reference: 40 x 40 graded wall points, and spherical harmonics on the sphere, which is 0.2 off the axis with a gap of only 0.2.
  RigidSphere s(sphere(0.6, Vec3(0, 0.2, 0), 8), circular_duct());
  const coupling::State place = coupling::placed(Vec3(3, 0.2, 0));  // the axial position does not matter
  const coupling::RigidMotion motion = s.body->motion(place);
  EXPECT_LT(error(motion.velocity[0], 1.459211), 2e-5);
  EXPECT_LT(error(motion.angular_velocity[2], 0.34762), 2e-4);
  EXPECT_LT(error(s.body->pressure_drop(place), 2.45144), 2e-4);
  EXPECT_LT(motion.velocity.tail<2>().norm(), 1e-6);  // no migration because the problem is reversible
}

TEST(RigidSphereInATube, OffTheAxisAddsTheAsymptoticPressureDrop) {
  // Asymptotically dp R/(mu V) = (160/3) a^3 b^2 + ..., with the radius a and the distance b from the axis. At b = 0.3 the next term is about 3 a^2
  // times the first term. The ratio of the two terms is therefore four times as large for twice the radius.
  double ratio[2];
  int k = 0;
  for (const double a : {0.05, 0.1}) {
    RigidSphere s(sphere(a, Vec3(0, 0, 0.3), 6), circular_duct(24, 25));
    ratio[k++] = s.body->pressure_drop(coupling::placed(Vec3(0, 0, 0.3))) / (160. / 3 * a * a * a * 0.09);
  }
  EXPECT_NEAR(ratio[0], 1, 0.01);
  EXPECT_NEAR((4 * ratio[0] - ratio[1]) / 3, 1, 1e-3);  // the error after extrapolation of the second-order term
}

}  // namespace tube_rigid_test
}  // namespace tanktread
