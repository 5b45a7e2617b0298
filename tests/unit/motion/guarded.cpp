// Tests that failed evaluations have the same outcome on all ranks.

#include "motion/guarded.hpp"

#include <cmath>
#include <functional>
#include <new>
#include <stdexcept>

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "base/stop.hpp"
#include "motion/integrator.hpp"
#include "system/parallel/agreement.hpp"
#include "system/parallel/ranks.hpp"
#include "tests/states.hpp"

namespace tanktread::motion {
namespace {

/// Model x' = -x, whose velocity throws if `fails` does.
class Decay : public PointMotion {
 public:
  std::function<void(const Net& x)> fails = [](const Net&) {};
  double size = 1;  // factor of the norm
  using PointMotion::velocity, PointMotion::norm;
  Net velocity(const Net& x) override {
    fails(x);
    return -x;
  }
  Net solve(double shift, const Net& r, double, const coupling::Secants&) override { return r / (1 + shift); }
  double norm(const Net& d) const override { return size * d.norm(); }
};

TimeState start(double step) {
  TimeState state;
  state.step = step;
  state.x = state_of(Net::Constant(1, 3, 1.));
  state.history = {-1 * state.x};
  return state;
}

TEST(GuardedDynamics, AFailedEvaluationShortensTheStepInEveryScheme) {
  for (const std::string& scheme : schemes) {
    TimeOptions options;
    options.scheme = scheme;
    options.tolerance = 0.1;
    Decay decay;
    decay.fails = [](const Net& x) {
      if (x(0, 0) < 0.7) throw std::logic_error("no basis");
    };
    GuardedDynamics motion(decay);
    TimeState state = start(2);  // an unlimited step would end far below 0.7
    const StepReport report = integrator(options)->advance(motion, state, 4);
    EXPECT_GT(report.rejected, 0) << scheme;
    EXPECT_GT(net(state.x)(0, 0), 0.7) << scheme;
    EXPECT_TRUE(state.history.front().allFinite()) << scheme;
    EXPECT_EQ(motion.failure(), "no basis");
  }
}

TEST(GuardedDynamics, AFirstTrialWithoutAVelocityStillGivesAnInitialStep) {
  Decay decay;
  GuardedDynamics motion(decay);
  TimeState state = start(0);
  const double step = first_step(motion, state, TimeOptions());
  decay.fails = [&](const Net& x) {
    if (x(0, 0) < net(state.x)(0, 0)) throw std::logic_error("no basis");
  };
  EXPECT_GT(first_step(motion, state, TimeOptions()), 0.1 * step);
}

TEST(GuardedDynamics, AFailureOnOneRankIsAFailureOnAllRanks) {
  const coupling::Ranks ranks;
  Decay decay;
  decay.fails = [&](const Net&) {
    if (ranks.rank() == ranks.size() - 1) throw RunFailure("not converged");
  };
  GuardedDynamics motion(decay);
  EXPECT_TRUE(net(motion.velocity(state_of(Net::Ones(2, 3)))).array().isNaN().all());
  EXPECT_EQ(motion.failure(), "not converged");
}

TEST(GuardedDynamics, LackOfMemoryDoesNotShortenTheStep) {
  const coupling::Ranks ranks;
  Decay decay;
  decay.fails = [&](const Net&) {
    if (ranks.rank() == ranks.size() - 1) throw std::bad_alloc();
  };
  GuardedDynamics motion(decay);
  EXPECT_THROW(motion.velocity(state_of(Net::Ones(2, 3))), RunFailure);
  EXPECT_EQ(motion.failure(), "there is not enough memory");
}

TEST(GuardedDynamics, AllRanksStopIfOneReceivesASignal) {
  const coupling::Ranks ranks;
  Decay decay;
  int evaluations = 0;
  decay.fails = [&](const Net&) { ++evaluations; };
  GuardedDynamics motion(decay);
  set_stop_request([&] { return ranks.rank() == ranks.size() - 1; });
  EXPECT_THROW(motion.velocity(state_of(Net::Ones(2, 3))), Stopped);
  EXPECT_EQ(evaluations, 0);
  EXPECT_TRUE(motion.velocity(state_of(Net::Ones(2, 3))).allFinite());  // the request has been answered
  set_stop_request({});
}

// Two ranks whose own errors would lie on either side of the tolerance take the same steps.
TEST(GuardedDynamics, TheFirstRankDecidesAboutSteps) {
  const coupling::Ranks ranks;
  for (const char* scheme : {"tr-bdf2", "bs3", "rkc2"}) {
    TimeOptions options;
    options.scheme = scheme;
    Decay decay;
    decay.size = 1 + ranks.rank();
    GuardedDynamics motion(decay);
    TimeState state = start(0.5);
    const auto integrate = integrator(options);
    for (int k = 0; k < 4; ++k) integrate->advance(motion, state, 4);
    EXPECT_EQ(state.time, coupling::of_first(state.time)) << scheme;
    EXPECT_EQ(state.step, coupling::of_first(state.step)) << scheme;
    EXPECT_EQ(motion.distance(state_of(Net::Zero(1, 3)), state_of(Net::Ones(1, 3))), std::sqrt(3.)) << scheme;
  }
}

}  // namespace
}  // namespace tanktread::motion
