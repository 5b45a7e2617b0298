// Tests of return maps of a motion with a known limit cycle: shape, period, multipliers.

#include <cmath>
#include <limits>
#include <numbers>

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "motion/periodic.hpp"
#include "tests/states.hpp"

namespace tanktread::motion {
namespace {

constexpr double inward = 0.15, damping = 0.1, frequency = 1.3;

/// Model of one control point that approaches the unit circle in x1 x3 and goes around it: with r and y = x2, r' = inward r (1 - r^2), y' = -damping
/// y. Over a period T the multipliers are exp(-2 inward T) and exp(-damping T).
class Cycle : public PointMotion {
 public:
  Net velocity(const Net& x) override {
    const double a = inward * (1 - x(0, 0) * x(0, 0) - x(0, 2) * x(0, 2));
    Net v(1, 3);
    v << a * x(0, 0) - frequency * x(0, 2), -damping * x(0, 1), a * x(0, 2) + frequency * x(0, 0);
    return v;
  }
  double norm(const Net& d) const override { return d.norm(); }
};

TimeOptions explicit_steps() {
  TimeOptions time;
  time.scheme = "bs3", time.tolerance = 1e-9;
  return time;
}

/// The parameter is the rotation in degrees. With 180 degrees, half a revolution is a period.
class Periodic : public testing::TestWithParam<double> {};

TEST_P(Periodic, ACycleIsFoundWithItsPeriodAndItsMultipliers) {
  const double turn = GetParam(), period = (turn == 0 ? 2 : 1) * std::numbers::pi / frequency;
  Cycle motion;
  const TimeOptions time = explicit_steps();
  PeriodicOptions options;
  options.period = 1.1 * period, options.turn = turn, options.tolerance = 1e-8, options.difference = 1e-3;
  State x = state_of(Net(Eigen::RowVector3d(0.5, 0.4, 0.1)));
  x = after_periods(motion, time, nullptr, options, x);
  ReturnMap map(motion, time, nullptr, options, x);
  const PeriodicReport report = find_periodic(map, nullptr, [](const State&, const State& p) { return p; }, x);
  ASSERT_TRUE(report.converged);
  EXPECT_NEAR(std::hypot(x.numbers()[0], x.numbers()[2]), 1, 1e-7);
  EXPECT_NEAR(x.numbers()[1], 0, 1e-7);
  EXPECT_NEAR(map.period(), period, 1e-6);
  const auto derivative = [&](const Eigen::VectorXd& d) { return Eigen::VectorXd(map.derivative(x, state_of(d.transpose())).numbers()); };
  const std::vector<coupling::Eigenpair> found = multipliers(derivative, 3, 2);
  ASSERT_EQ(found.size(), 2U);
  const double slow = std::exp(-damping * period), fast = std::exp(-2 * inward * period);
  EXPECT_NEAR(found[0].value.real(), slow, 1e-4 * slow);
  EXPECT_NEAR(found[1].value.real(), fast, 1e-4 * slow);
  EXPECT_NEAR(std::abs(found[0].vector[1]), 1, 1e-3);  // along x2
}

INSTANTIATE_TEST_SUITE_P(Turns, Periodic, testing::Values(0., 180.));

TEST(Periodic, AMotionThatStartsAtRestNeedsNoFinalTime) {
  class Driven : public PointMotion {
   public:
    void set_time(double time, double) override { time_ = time; }
    Net velocity(const Net&) override { return Net::Constant(1, 3, std::sin(time_)); }
    double norm(const Net& d) const override { return d.norm(); }

   private:
    double time_ = 0;
  } motion;
  TimeOptions time = explicit_steps();
  time.final_time = std::numeric_limits<double>::quiet_NaN();  // decks of searches have no final time
  PeriodicOptions options;
  options.driven = true, options.period = 2 * std::numbers::pi;
  const State x = state_of(Net::Constant(1, 3, 0.5));
  EXPECT_LT(State(after_periods(motion, time, nullptr, options, x) - x).norm(), 1e-7);
}

TEST(Periodic, AMotionThatIsNotPeriodicIsReported) {
  Cycle motion;
  const TimeOptions time = explicit_steps();
  PeriodicOptions options;
  options.period = 0.4 / frequency;  // the search covers up to a tenth of a revolution
  const State x = state_of(Net(Eigen::RowVector3d(1, 0, 0)));
  ReturnMap map(motion, time, nullptr, options, x);
  EXPECT_THROW(map(x), RunFailure);
}

}  // namespace
}  // namespace tanktread::motion
