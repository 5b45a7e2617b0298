#include "stokes/ambient_flow.hpp"

#include <gtest/gtest.h>

namespace tanktread::stokes {
namespace {

FlowOptions flow(const char* type, double rate = 1.5) {
  FlowOptions options;
  options.type = type;
  options.shear_rate = rate;
  return options;
}

const Vec3 x(0.3, -0.2, 0.7);

TEST(AmbientFlow, EveryFlowIsIncompressibleAndAffine) {
  FlowOptions linear = flow("linear", 1), roll = flow("four-roll"), uniform = flow("uniform");
  linear.gradient = (Mat3() << 0.1, 2, 3, 4, 0.5, 6, 7, 8, -0.6).finished();
  roll.roll_parameter = 0.6;
  uniform.velocity = Vec3(1, 2, 3);
  for (const FlowOptions& options :
       {flow("quiescent"), uniform, flow("simple shear"), roll, flow("planar hyperbolic"), flow("uniaxial extension"), linear}) {
    const AmbientFlow f(options);
    EXPECT_NEAR(f.gradient(x).trace(), 0, 1e-15) << options.type;
    EXPECT_LT((f.velocity(x) - f.velocity(Vec3::Zero()) - f.gradient(x) * x).norm(), 1e-15) << options.type;
  }
}

TEST(AmbientFlow, HasTheVelocitiesOfItsDefinition) {
  FlowOptions roll = flow("four-roll");
  roll.roll_parameter = 0.6;
  EXPECT_LT((AmbientFlow(flow("simple shear")).velocity(x) - 1.5 * Vec3(x[2], 0, 0)).norm(), 1e-15);
  EXPECT_LT((AmbientFlow(flow("planar hyperbolic")).velocity(x) - 1.5 * Vec3(x[0], 0, -x[2])).norm(), 1e-15);
  EXPECT_LT((AmbientFlow(flow("uniaxial extension")).velocity(x) - 1.5 * Vec3(-x[0] / 2, -x[1] / 2, x[2])).norm(), 1e-15);
  EXPECT_LT((AmbientFlow(roll).velocity(x) - 0.75 * Vec3(1.6 * x[0] + 0.4 * x[2], 0, -0.4 * x[0] - 1.6 * x[2])).norm(), 1e-15);  // (P-48)
}

TEST(AmbientFlow, TakesTheRateOfALinearFlowFromItsGradient) {
  FlowOptions linear = flow("linear", 1);
  linear.gradient = Mat3::Zero();
  (*linear.gradient)(0, 2) = 3;  // simple shear at rate 3
  EXPECT_NEAR(AmbientFlow(linear).rate(), 3, 1e-14);
  EXPECT_EQ(AmbientFlow(flow("quiescent")).rate(), 0);
}

}  // namespace
}  // namespace tanktread::stokes
