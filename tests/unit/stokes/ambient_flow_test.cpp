#include "stokes/flow/ambient_flow.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "deck/document.hpp"

namespace tanktread::stokes {
namespace {

FlowOptions flow(const char* type, double rate = 1.5) {
  FlowOptions options;
  options.type = type;
  options.shear_rate = rate;
  return options;
}

const Vec3 x(0.3, -0.2, 0.7);

struct NoKeys {
  void declare(deck::Section&) {}
};

TEST(FlowOptions, RefuseARegisteredFlowWithTheNameOfAnotherType) {
  for (const char* name : {"parabolic", "rotlet"}) {
    UserFlows flows;
    flows.add<NoKeys>(name, "a flow", [](const NoKeys&) { return std::shared_ptr<const UserFlow>(); });
    FlowOptions options;
    options.registered = &flows;
    const auto read = [&] { deck::read_text("Tanktread: {type: quiescent}").declare(options); };
    if (std::string(name) == "parabolic")
      EXPECT_THROW(read(), std::logic_error);
    else
      EXPECT_NO_THROW(read());
  }
}

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
  // four-roll flow: equation 48 of Maestre et al. 2017
  EXPECT_LT((AmbientFlow(roll).velocity(x) - 0.75 * Vec3(1.6 * x[0] + 0.4 * x[2], 0, -0.4 * x[0] - 1.6 * x[2])).norm(), 1e-15);
}

TEST(AmbientFlow, HasTheRateOfALinearFlowFromItsGradient) {
  FlowOptions linear = flow("linear", 1);
  linear.gradient = Mat3::Zero();
  (*linear.gradient)(0, 2) = 3;  // simple shear at rate 3
  EXPECT_NEAR(AmbientFlow(linear).rate(), 3, 1e-14);
  EXPECT_EQ(AmbientFlow(flow("quiescent")).rate(), 0);
}

/// Integrates dF/dt = L F by many steps of the classical Runge-Kutta scheme, from 0 to `end`, with the gradients of `flow`.
Mat3 integrated(AmbientFlow flow, double end, int steps) {
  Mat3 f = Mat3::Identity();
  const double h = end / steps;
  for (int k = 0; k < steps; ++k) {
    const auto gradient = [&](double part) {
      flow.set_time((k + part) * h, k * h);
      return flow.gradient(Vec3::Zero());
    };
    const Mat3 k1 = gradient(0) * f, k2 = gradient(0.5) * (f + h / 2 * k1), k3 = gradient(0.5) * (f + h / 2 * k2), k4 = gradient(1) * (f + h * k3);
    f += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4);
  }
  return f;
}

TEST(AmbientFlow, DeformsALatticeByTheIntegralOfItsGradient) {
  FlowOptions options = flow("linear", 1);
  options.gradient = (Mat3() << 0.1, 2, 3, 4, 0.5, 6, 7, 8, -0.6).finished() / 5;
  options.history = FlowHistory{.times = std::vector<double>{0.25, 0.75, 0.75, 1}, .amplitudes = std::vector<double>{1, -0.5, 2, 1},
                                .angles = std::vector<double>{20, 90, -40, -40}, .axis = "x2"};
  // Before the first time, within a piece, at a jump, after the last time. Steps of the integration end at all times of the table.
  for (const double end : {0.2, 0.5, 0.75, 1.25}) {
    const Mat3 f = AmbientFlow(options).deformation(end);
    EXPECT_LT((f - integrated(AmbientFlow(options), end, 1200)).norm(), 1e-10 * f.norm()) << end;
    EXPECT_NEAR(f.determinant(), 1, 1e-13);
  }
  options.history = FlowHistory{.type = "sine", .mean = 0.3, .amplitude = 2, .frequency = 0.7, .phase = 25};
  EXPECT_LT((AmbientFlow(options).deformation(1.3) - integrated(AmbientFlow(options), 1.3, 1000)).norm(), 1e-9);
}

FlowOptions parabolic(const char* profile) {
  FlowOptions options = flow("parabolic", 1);
  options.profile = profile, options.maximum_velocity = 3, options.half_width = 2;
  return options;
}

TEST(AmbientFlow, ParabolicIsOneOverItsHalfWidthAndHasTheGradientOfItsVelocity) {
  for (const char* profile : {"round", "plane"}) {
    const AmbientFlow f(parabolic(profile));
    const bool round = profile == std::string("round");
    EXPECT_FALSE(f.affine());
    EXPECT_EQ(f.rate(), 1.5);
    EXPECT_EQ(f.velocity(Vec3(7, 0, 0)), Vec3(3, 0, 0));
    EXPECT_LT(f.velocity(Vec3(0, 0, -2)).norm(), 1e-15);
    EXPECT_NEAR(f.velocity(Vec3(0, 2, 0))[0], round ? 0 : 3, 1e-15);
    for (int k = 0; k < 3; ++k) {
      const Vec3 step = 1e-3 * Vec3::Unit(k);  // central differences of a quadratic are exact
      EXPECT_LT(((f.velocity(x + step) - f.velocity(x - step)) / 2e-3 - f.gradient(x).col(k)).norm(), 1e-12);
    }
    const Net points = (Net(2, 3) << x.transpose(), -2 * x.transpose()).finished();
    EXPECT_EQ(f.velocities(points).row(0), f.velocity(x).transpose());
    EXPECT_EQ(f.gradients(points)[1], f.gradient(-2 * x));
  }
}

FlowHistory stopped() {
  FlowHistory history;
  history.times = {1, 2, 2}, history.amplitudes = {1, 3, 0}, history.angles = {0, 90, 90}, history.axis = "x2";
  return history;
}

TEST(FlowHistory, OfATableIsPiecewiseLinearAndJumpsAtEqualTimes) {
  const FlowHistory history = stopped();
  EXPECT_EQ(history.at(0, 0).amplitude, 1);
  EXPECT_EQ(history.at(1.5, 1).amplitude, 2);
  EXPECT_EQ(history.at(2, 1.5).amplitude, 3);  // end of a step
  EXPECT_EQ(history.at(2, 2).amplitude, 0);    // start of a step
  EXPECT_EQ(history.at(9, 2).amplitude, 0);
  EXPECT_LT((history.at(2, 1).turn * Vec3::UnitZ() - Vec3::UnitX()).norm(), 1e-15);
  EXPECT_EQ(history.next_kink(0), 1);
  EXPECT_EQ(history.next_kink(1), 2);
  EXPECT_EQ(history.next_kink(2), std::numeric_limits<double>::infinity());
}

/// A rotlet (point torque) at (0, 0, 2).
struct Rotlet : UserFlow {
  static Vec3 from(const Vec3& at) { return at - Vec3(0, 0, 2); }
  Vec3 velocity(const Vec3& at) const override { return Vec3(from(at)[2], 0, -from(at)[0]) / std::pow(from(at).norm(), 3); }
  Mat3 gradient(const Vec3& at) const override {
    Mat3 turn = Mat3::Zero();
    turn(0, 2) = 1, turn(2, 0) = -1;
    return turn / std::pow(from(at).norm(), 3) - 3 * turn * from(at) * from(at).transpose() / std::pow(from(at).norm(), 5);
  }
  double rate() const override { return 0.125; }
};

FlowOptions rotlet() {
  FlowOptions options = flow("rotlet", 1);
  options.user = std::make_shared<Rotlet>();
  return options;
}

TEST(AmbientFlow, OfAnotherProgramIsUsedUnchanged) {
  const AmbientFlow f(rotlet());
  EXPECT_EQ(f.velocity(x), Rotlet().velocity(x));
  EXPECT_EQ(f.velocities(Net(x.transpose())).row(0), Rotlet().velocity(x).transpose());
  EXPECT_EQ(f.gradients(Net(x.transpose())).front(), Rotlet().gradient(x));
  EXPECT_EQ(f.rate(), 0.125);
  EXPECT_FALSE(f.affine());
}

/// Simple shear about x3 = 1.
struct Shear : UserFlow {
  Vec3 velocity(const Vec3& at) const override { return Vec3(at[2] - 1, 0, 0); }
  Mat3 gradient(const Vec3&) const override { return Vec3::UnitX() * Vec3::UnitZ().transpose(); }
  double rate() const override { return 1; }
  bool affine() const override { return true; }
};

TEST(AmbientFlow, OfAnotherProgramIsAdaptedToPlates) {
  FlowOptions options = flow("shear", 1);
  options.user = std::make_shared<Shear>();
  options.viscosity = 0.7;
  const Vec3 first(0.5, 0.2, 0), second(-1, 0.4, 0), bottom(0, 0, -1), top(0.3, -0.6, 2), middle(0.1, 0.2, 0.5);
  options.plates = Plates{bottom, Vec3::UnitZ(), 3., first, second};
  const AmbientFlow couette(options);
  EXPECT_TRUE(couette.affine());
  EXPECT_LT((couette.gradient(x) - (second - first) / 3 * Vec3::UnitZ().transpose()).norm(), 1e-15);
  EXPECT_LT((couette.deformation(0.5) - Mat3::Identity() - couette.gradient(x) / 2).norm(), 1e-15);
  options.pressure_gradient = Vec3(-2, 0.3, 0);
  const AmbientFlow f(options);
  EXPECT_FALSE(f.affine());
  EXPECT_LT((f.velocity(bottom) - first).norm() + (f.velocity(top) - second).norm(), 1e-14);
  EXPECT_LT((f.velocity(middle) - (first + second) / 2 + *options.pressure_gradient * 9 / (8 * 0.7)).norm(), 1e-14);
  const Net points = (Net(2, 3) << x.transpose(), top.transpose()).finished();
  EXPECT_EQ(f.velocities(points).row(0), f.velocity(x).transpose());
  for (int k = 0; k < 3; ++k) {
    const Vec3 step = 1e-3 * Vec3::Unit(k);  // central differences of a quadratic are exact
    EXPECT_LT(((f.velocity(x + step) - f.velocity(x - step)) / 2e-3 - f.gradient(x).col(k)).norm(), 1e-12);
  }
}

TEST(FlowHistory, MultipliesAndRotatesAnyFlow) {
  FlowOptions uniform = flow("uniform"), roll = flow("four-roll");
  uniform.velocity = Vec3(1, 2, 3);
  roll.roll_parameter = 0.6;
  for (FlowOptions options : {uniform, roll, flow("simple shear"), parabolic("plane"), rotlet()}) {
    const AmbientFlow steady(options);
    options.history = stopped();
    AmbientFlow f(options);
    EXPECT_EQ(f.velocity(x), steady.velocity(x)) << "amplitude 1 as long as no time is told";
    EXPECT_TRUE(f.set_time(1.5, 1.0));
    EXPECT_FALSE(f.set_time(1.5, 1.2)) << "the same flow as before";
    const Mat3 turn = stopped().turn(45);
    EXPECT_LT((f.velocity(x) - 2 * turn * steady.velocity(turn.transpose() * x)).norm(), 1e-14) << options.type;
    EXPECT_LT((f.gradient(x) - 2 * turn * steady.gradient(turn.transpose() * x) * turn.transpose()).norm(), 1e-14) << options.type;
    EXPECT_TRUE(f.set_time(2, 2));
    EXPECT_EQ(f.velocity(x).norm(), 0);
    EXPECT_EQ(f.affine(), steady.affine());
    EXPECT_EQ(f.rate(), steady.rate());
  }
}

TEST(FlowHistory, OfASineHasItsMeanItsAmplitudeAndItsPhase) {
  FlowHistory history;
  history.type = "sine", history.mean = 0.5, history.amplitude = 2, history.frequency = 0.25, history.phase = 90;
  EXPECT_NEAR(history.at(0, 0).amplitude, 2.5, 1e-15);
  EXPECT_NEAR(history.at(1, 0).amplitude, 0.5, 1e-15);
  EXPECT_NEAR(history.at(2, 0).amplitude, -1.5, 1e-15);
}

}  // namespace
}  // namespace tanktread::stokes
