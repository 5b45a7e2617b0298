// Tests of the accuracy of the search for steady shapes.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "motion/steady.hpp"
#include "tests/states.hpp"

namespace tanktread::motion {
namespace {

constexpr double slow = 0.02;  ///< a mode of this rate decays by 1 % in an implicit step of the search

/// Model of points that move to the origin: the first at the rate `slow`, the others at rates between 1 and 2, faster at larger distance. The frozen
/// Jacobian is 0.
class Slow : public PointMotion {
 public:
  using PointMotion::velocity, PointMotion::norm;
  Net velocity(const Net& x) override {
    Net v(x.rows(), 3);
    for (int i = 0; i < x.rows(); ++i) {
      const double rate = i == 0 ? slow : 1 + i / static_cast<double>(x.rows());
      v.row(i) = -rate * (1 + x.row(i).squaredNorm()) * x.row(i);
    }
    return v;
  }
  double norm(const Net& d) const override { return d.norm() / std::sqrt(static_cast<double>(d.rows())); }
};

State start() {
  Net x(40, 3);
  for (int i = 0; i < x.size(); ++i) x.data()[i] = 0.01 * std::cos(i);
  return state_of(x);
}

// The map is affine, and all directions have been sampled: the estimate is exact up to round-off divided by 1 - rho = 0.01.
TEST(FixedPointError, IsExactForAnAffineMap) {
  State x = state_of((Net(2, 3) << 1, 2, 3, -1, 0.5, 2).finished());
  const Net rates = (Net(2, 3) << 0.01, 0.01, 0.5, 0.5, 0.01, 0.9).finished();
  FixedPointError error(10);
  State found;
  for (int k = 0; k < 4; ++k) {  // three different rates need three secants
    const State f = state_of(-rates.cwiseProduct(net(x)));
    found = error(x, f);
    if (k < 3) x += f;
  }
  EXPECT_NEAR(State(found - x).norm() / x.norm(), 0, 1e-10);
}

// The correction is a hundredth of the error. The estimate is tested to a factor of 2, because the map is not affine.
TEST(FixedPointError, DetectsTheErrorOfASlowMode) {
  Slow motion;
  FixedPointError error(10);
  State x = start();
  for (int k = 0; k < 60; ++k) {
    const State f = 0.5 * motion.velocity(x), found = error(x, f);
    if (k >= 10) {
      EXPECT_GT(motion.norm(found), 0.5 * motion.norm(x)) << k;
      EXPECT_LT(motion.norm(found), 2 * motion.norm(x)) << k;
    }
    x += f;
  }
}

class Steady : public testing::TestWithParam<const char*> {};

// The error is at most twice the tolerance; with the correction as the criterion it was up to 35 times the tolerance. Tolerances above a hundredth of
// the initial error are met before the slow mode dominates.
TEST_P(Steady, EndsWhenTheErrorIsBelowTheTolerance) {
  Slow motion;
  for (const double tolerance : {1e-5, 1e-7, 1e-9}) {
    SteadyEquations equations(motion, {}, 0.5, start());
    SteadyOptions options;
    options.method = GetParam(), options.tolerance = tolerance;
    State x = start();
    const SteadyReport report = find_steady(equations, options, {}, x);
    ASSERT_TRUE(report.converged) << tolerance;
    EXPECT_LE(report.rest, tolerance);
    EXPECT_LE(motion.norm(x), 2 * tolerance);
  }
}

// Only the slow mode is present at the start: its correction is a tenth of the tolerance, its error ten times the tolerance.
TEST_P(Steady, DoesNotTrustTheFirstCorrection) {
  Slow motion;
  State x = state_of(Net::Zero(40, 3));
  x.numbers()[0] = 1e-4 * std::sqrt(40.0);
  SteadyEquations equations(motion, {}, 0.5, x);
  SteadyOptions options;
  options.method = GetParam(), options.tolerance = 1e-5;
  ASSERT_TRUE(find_steady(equations, options, {}, x).converged);
  EXPECT_LE(motion.norm(x), 2e-5);
}

/// A model of a crumpled surface: it has no steady shape, and all velocities are large, but so is the Jacobian, so that corrections are small.
class Crumpled : public PointMotion {
 public:
  using PointMotion::velocity, PointMotion::norm;
  Net velocity(const Net& x) override { return 1e6 * (1 + (-1e9 * x).array().exp()).matrix(); }
  Net solve(double, const Net& r, double, const coupling::Secants&) override { return 1e-15 * r; }
  double norm(const Net& d) const override { return d.norm() / std::sqrt(static_cast<double>(d.rows())); }
};

TEST_P(Steady, DoesNotAcceptAMovingShapeAsSteady) {
  Crumpled motion;
  State x = state_of(Net::Zero(40, 3));
  SteadyEquations equations(motion, {}, 0.5, x);
  SteadyOptions options;
  options.method = GetParam(), options.tolerance = 1e-5;
  const SteadyReport report = find_steady(equations, options, {}, x);
  EXPECT_FALSE(report.converged);
  EXPECT_GT(report.rest, 1e5);  // half of the velocity, not the correction of 1e-9
}

/// A model whose velocity has the same size everywhere and other directions in each evaluation, so that no iterate is better than another.
class Restless : public PointMotion {
 public:
  using PointMotion::velocity, PointMotion::norm;
  Net velocity(const Net& x) override {
    ++velocities;
    Net v = Net::Zero(x.rows(), 3);
    for (Eigen::Index i = 0; i < v.rows(); ++i) v(i, 0) = 0.1 * std::cos(velocities * (i + 1.0)), v(i, 1) = 0.1 * std::sin(velocities * (i + 1.0));
    return v;
  }
  double norm(const Net& d) const override { return d.norm() / std::sqrt(static_cast<double>(d.rows())); }
  int velocities = 0;
};

TEST_P(Steady, EndsEarlyAtAKnownObstacle) {
  int velocities = 0;  // without obstacle
  for (const char* obstacle : {"", "the membrane is slack"}) {
    Restless motion;
    State x = state_of(Net::Zero(40, 3));
    SteadyEquations equations(motion, {}, 0.5, x, [&](const State&) { return obstacle; });
    SteadyOptions options;
    options.method = GetParam();
    if (options.method == "newton-krylov") options.iterations = 3;  // each takes many products
    const SteadyReport report = find_steady(equations, options, {}, x, 5);
    EXPECT_FALSE(report.converged);
    EXPECT_EQ(report.why, obstacle);
    if (report.why.empty()) velocities = motion.velocities;
    else if (options.method == "anderson") EXPECT_LT(motion.velocities, velocities / 4);
  }
}

/// A model whose velocity is NaN. relabellings() (motions of points along the surface that keep the shape) throws, because it needs a velocity.
/// `assemblies` counts the assemblies of the Jacobian's operators.
class Unknown : public Slow {
 public:
  using Slow::velocity;
  Net velocity(const Net& x) override { return coupling::not_a_number(x); }
  std::vector<State> relabellings(const State&) override { throw RunFailure("there is no velocity"); }
  void freeze(const State&) override { ++assemblies; }
  int assemblies = 0;
};

TEST_P(Steady, RejectsAShapeWhoseVelocityCannotBeEvaluated) {
  Unknown motion;
  SteadyEquations equations(motion, {}, 0.5, start());
  SteadyOptions options;
  options.method = GetParam();
  State x = start();
  EXPECT_FALSE(find_steady(equations, options, {}, x).converged);
  EXPECT_EQ(motion.assemblies, 1);  // the shape did not change after the first assembly
}

INSTANTIATE_TEST_SUITE_P(Methods, Steady, testing::Values("anderson", "newton-krylov"),
                         [](const auto& info) { return info.param[0] == 'a' ? "Anderson" : "Newton"; });

}  // namespace
}  // namespace tanktread::motion
