// Integrators on ordinary differential equations with known solutions: orders, stability, step control, failure.

#include <cmath>
#include <limits>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "motion/integrator.hpp"

namespace tanktread::motion {
namespace {

/// One control point whose three coordinates follow
///   x' = -rate (x - cos t) - sin t,  y' = -y^2,  t' = 1:   x = cos t, y = 1/(1 + t) from x = 1, y = 1, t = 0,
/// with the exact Jacobian, so that a quasi-Newton iteration is Newton's.
class Model : public coupling::Dynamics {
 public:
  explicit Model(double rate) : rate_(rate) {}
  Net velocity(const Net& x) override {
    ++evaluations;
    Net v(1, 3);
    v << -rate_ * (x(0, 0) - std::cos(x(0, 2))) - std::sin(x(0, 2)), -x(0, 1) * x(0, 1), 1;
    return v;
  }
  void freeze(const Net&) override { ++assemblies; }
  void linearise(const Net& x) override { at_ = x; }
  Net solve(double shift, const Net& r, double) override {
    Mat3 j = Mat3::Zero();
    j(0, 0) = -rate_;
    j(0, 2) = -rate_ * std::sin(at_(0, 2)) - std::cos(at_(0, 2));
    j(1, 1) = -2 * at_(0, 1);
    const Mat3 w = Mat3::Identity() - shift * j;
    return (w.inverse() * r.transpose()).transpose();
  }
  void restore_volume(Net&) override {}
  double norm(const Net& d) const override { return d.norm() / std::sqrt(3.0); }

  int evaluations = 0, assemblies = 0;

 private:
  double rate_;
  Net at_;
};

TimeOptions with(const std::string& scheme) {
  TimeOptions options;
  options.scheme = scheme;
  options.newton_tolerance = 1e-6;
  options.iteration_tolerance = 1e-9;  // errors measured below are above 1e-6
  return options;
}

State start(double step) {
  State state;
  state.step = step;
  state.x = Net(1, 3);
  state.x << 1, 1, 0;
  return state;
}

double error_at_one(TimeOptions options, double step, double rate) {
  options.fixed_step = step;
  Model model(rate);
  State state = start(step);
  const auto scheme = integrator(options);
  while (state.time < 1) scheme->advance(model, state, 1);
  EXPECT_EQ(state.time, 1);
  return std::hypot(state.x(0, 0) - std::cos(1.0), state.x(0, 1) - 0.5);
}

double observed_order(const std::string& scheme, double rate) {
  return std::log2(error_at_one(with(scheme), 0.04, rate) / error_at_one(with(scheme), 0.02, rate));
}

// Orders within 0.15: the next term of the error is of relative size dt.
TEST(Integrators, TrBdf2IsOfSecondOrder) { EXPECT_NEAR(observed_order("tr-bdf2", 2), 2, 0.15); }
TEST(Integrators, Bs3IsOfThirdOrder) { EXPECT_NEAR(observed_order("bs3", 2), 3, 0.15); }
TEST(Integrators, CrankNicolsonIsOfSecondOrder) { EXPECT_NEAR(observed_order("crank-nicolson", 2), 2, 0.15); }

TEST(Integrators, TrBdf2ForgetsAStiffTransientAtOnce) {
  TimeOptions options = with("tr-bdf2");
  options.fixed_step = 0.1;
  Model model(1e8);
  State state = start(0.1);
  state.x(0, 0) = 3;  // far off the slow solution
  const auto scheme = integrator(options);
  for (int k = 0; k < 2; ++k) scheme->advance(model, state, 10);
  EXPECT_NEAR(state.x(0, 0), std::cos(state.x(0, 2)), 1e-6);  // L-stable: the transient is divided by about dt rate each step
}

TEST(Integrators, ControlledStepsMeetTheToleranceAndGrow) {
  for (const char* scheme : {"tr-bdf2", "bs3"}) {
    double previous = 0;
    for (const double tolerance : {1e-4, 1e-6}) {
      TimeOptions options = with(scheme);
      options.tolerance = tolerance;
      Model model(2);
      State state = start(1e-4);
      const auto integrate = integrator(options);
      int steps = 0;
      while (state.time < 1) {
        const StepReport report = integrate->advance(model, state, 1);
        EXPECT_LE(report.error, tolerance);
        ++steps;
      }
      // The problem forgets errors, so the sum of `steps` local ones, each below the tolerance, bounds the global one.
      EXPECT_LT(std::hypot(state.x(0, 0) - std::cos(1.0), state.x(0, 1) - 0.5), std::sqrt(3.0) * steps * tolerance);
      EXPECT_GT(steps, previous);
      previous = steps;
    }
  }
}

TEST(Integrators, CrankNicolsonFollowsThePapersStepRule) {
  Model gentle(0.1), stiff(100);
  State easy = start(1e-6), hard = start(0.04);  // 0.04 x 100 = 4 > 2: the sub-iteration diverges
  const TimeOptions options = [] {
    TimeOptions o;
    o.scheme = "crank-nicolson";
    o.count_euler_step = false;
    return o;
  }();
  const auto scheme = integrator(options);
  scheme->advance(gentle, easy, 1);
  EXPECT_DOUBLE_EQ(easy.step, 1.33e-6);  // fewer than four sub-iterations: longer by 1.33
  const StepReport report = scheme->advance(stiff, hard, 1);
  EXPECT_GE(report.rejected, 3);
  EXPECT_NEAR(report.step, 0.04 * std::pow(0.75, report.rejected), 1e-15);
}

TEST(Integrators, AStepBelowTheMinimumStopsTheRunAndKeepsTheState) {
  class Broken : public Model {
   public:
    Broken() : Model(1) {}
    Net velocity(const Net&) override { return Net::Constant(1, 3, std::numeric_limits<double>::quiet_NaN()); }
  };
  for (const char* scheme : {"tr-bdf2", "bs3", "crank-nicolson"}) {
    TimeOptions options = with(scheme);
    options.minimum_step = 1e-5;
    Broken model;
    State state = start(1e-3);
    state.history = {Net::Zero(1, 3)};
    const Net before = state.x;
    EXPECT_THROW(integrator(options)->advance(model, state, 1), RunFailure) << scheme;
    EXPECT_EQ(state.x, before);
    EXPECT_EQ(state.time, 0);
  }
}

TEST(Integrators, StepsTowardsALimitLeaveNoSliver) {
  EXPECT_EQ(step_towards(1, 2, 5), 1);
  EXPECT_EQ(step_towards(1, 2, 0.7), 0.5);
  EXPECT_EQ(step_towards(1, 2, 0.3), 0.3);
}

TEST(Integrators, ACopiedStateGoesOnToTheLastBit) {
  for (const char* scheme : {"tr-bdf2", "bs3", "crank-nicolson"}) {
    Model model(3);
    State state = start(0.01);
    const auto one = integrator(with(scheme));
    for (int k = 0; k < 5; ++k) one->advance(model, state, 1);
    State copy = state;
    const auto other = integrator(with(scheme));
    for (int k = 0; k < 5; ++k) {
      one->advance(model, state, 1);
      other->advance(model, copy, 1);
    }
    EXPECT_EQ(state.x, copy.x) << scheme;
    EXPECT_EQ(state.step, copy.step) << scheme;
  }
}

}  // namespace
}  // namespace tanktread::motion
