// Tests of spheres in unbounded parabolic flow, compared with Faxen's laws.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "surface/transport.hpp"
#include "tests/evolution.hpp"
#include "tests/rigid.hpp"

namespace tanktread {
namespace {

using std::numbers::pi;

const Vec3 centre(0.3, -0.2, 0.5);
constexpr double a = 0.8, fastest = 2, half_width = 1.6;

/// Values of v_inf, its Laplacian and its curl at the centre.
struct Exact {
  Vec3 velocity, laplacian, curl;
  explicit Exact(bool round) {
    const double bend = fastest / (half_width * half_width), x2 = round ? centre[1] : 0, x3 = centre[2];
    velocity = {fastest - bend * (x2 * x2 + x3 * x3), 0, 0};
    laplacian = {-2 * bend * (round ? 2 : 1), 0, 0};
    curl = {0, -2 * bend * x3, 2 * bend * x2};
  }
};

std::vector<std::string> in_flow(const char* profile, std::vector<std::string> more) {
  more.insert(more.end(), {"Flow/type=parabolic", std::string("Flow/profile=") + profile, "Flow/maximum velocity=2", "Flow/half width=1.6",
                           "Particle/center=[0.3, -0.2, 0.5]", "Time/final time=1"});
  return more;
}

TEST(ParabolicFlow, ExertsFaxensForceAndTorqueOnAFixedSphere) {
  for (const char* profile : {"round", "plane"}) {
    const RigidSolution s = rigid_solution("spheroid_cube.yaml", in_flow(profile, {"Particle/semi-axes=[0.8, 0.8, 0.8]",
                                                                                  "Particle/velocity=[0, 0, 0]", "Surface/elements per side=6"}));
    const Exact exact(profile == std::string("round"));
    const Vec3 force = 6 * pi * a * (exact.velocity + a * a / 6 * exact.laplacian), torque = 4 * pi * a * a * a * exact.curl;
    EXPECT_LT((s.force - force).norm() / force.norm(), 2e-5) << profile;  // interpolation of the flow causes 8e-6
    EXPECT_LT((s.torque - torque).norm() / torque.norm(), 1e-5) << profile;
    EXPECT_TRUE(std::isnan(s.error)) << "the exact solution of a uniform flow is none here";
  }
}

TEST(ParabolicFlow, MovesAnUnstressedCapsuleWithTheMeanVelocityOverItsVolume) {
  const Evolution run(in_flow("round", {"Particle/radius=0.8", "Surface/elements per side=5"}));
  const Exact exact(true);
  const Vec3 velocity = surface::centroid_velocity(run.capsule->geometry().bezier(), run.x(), run.motion->shape(run.state.history[0]));
  // error of the interpolation on 152 control points
  EXPECT_LT((velocity - exact.velocity - a * a / 10 * exact.laplacian).norm(), 1e-3 * velocity.norm());
}

}  // namespace
}  // namespace tanktread
