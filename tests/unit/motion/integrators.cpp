// Tests of time integrators on ordinary differential equations with known solutions: order, stability, step control, failure.

#include <cmath>
#include <limits>
#include <utility>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "motion/integrator.hpp"
#include "motion/quasi_newton.hpp"
#include "motion/schemes.hpp"
#include "tests/states.hpp"

namespace tanktread::motion {
namespace integrators_test {

/// Model of one control point, whose three coordinates follow
///   x' = -rate (x - cos t) - sin t,  y' = -y^2,  t' = 1:   x = cos t, y = 1/(1 + t) from x = 1, y = 1, t = 0,
/// with the exact Jacobian, so that the quasi-Newton iteration is Newton's method.
class Model : public PointMotion {
 public:
  using PointMotion::velocity, PointMotion::solve, PointMotion::linearise, PointMotion::norm;
  explicit Model(double rate) : rate_(rate) {}
  Net velocity(const Net& x) override {
    ++evaluations;
    Net v(1, 3);
    v << -rate_ * (x(0, 0) - std::cos(x(0, 2))) - std::sin(x(0, 2)), -x(0, 1) * x(0, 1), 1;
    return v;
  }
  void freeze(const State&) override { ++assemblies; }
  double frozen_bytes() const override { return 12; }
  void linearise(const Net& x) override { at_ = x; }
  Net solve(double shift, const Net& r, double, const coupling::Secants&) override {
    ++solves;
    Mat3 j = Mat3::Zero();
    j(0, 0) = -rate_;
    j(0, 2) = -rate_ * std::sin(at_(0, 2)) - std::cos(at_(0, 2));
    j(1, 1) = -2 * at_(0, 1);
    const Mat3 w = Mat3::Identity() - shift * j;
    return (w.inverse() * r.transpose()).transpose();
  }
  double norm(const Net& d) const override { return d.norm() / std::sqrt(3.0); }

  int evaluations = 0, assemblies = 0, solves = 0;

 protected:
  double rate() const { return rate_; }

 private:
  double rate_;
  Net at_;
};

/// The model with a Jacobian that contains half of the stiffness and nothing of y' = -y^2. The secants supply the remaining part.
class Incomplete : public Model {
 public:
  using Model::Model;
  using Model::solve, Model::linearise, Model::jacobian_error;
  void linearise(const Net& x) override { time_ = x(0, 2); }
  Net solve(double shift, const Net& r, double, const coupling::Secants& secants) override {
    Mat3 w = Mat3::Identity() - shift * jacobian();
    for (int c = 0; c < 3; ++c) w.col(c) -= shift * secants(state_of(Vec3::Unit(c).transpose())).numbers();
    return (w.inverse() * r.transpose()).transpose();
  }
  Net jacobian_error(const Net& change, const Net& delta, double shift) override {
    return change + delta / shift - delta * jacobian().transpose();
  }

 private:
  Mat3 jacobian() const {
    Mat3 j = Mat3::Zero();
    j(0, 0) = -0.5 * rate();
    j(0, 2) = -rate() * std::sin(time_) - std::cos(time_);
    return j;
  }
  double time_ = 0;
};

TimeOptions with(const std::string& scheme) {
  TimeOptions options;
  options.scheme = scheme;
  options.newton_tolerance = 1e-6;
  options.iteration_tolerance = 1e-9;  // errors measured below are above 1e-6
  return options;
}

TimeState start(double step) {
  TimeState state;
  state.step = step;
  state.x = state_of(Eigen::RowVector3d(1, 1, 0));
  return state;
}

double error_at_one(TimeOptions options, double step, double rate) {
  options.fixed_step = step;
  Model model(rate);
  TimeState state = start(step);
  const auto scheme = integrator(options);
  while (state.time < 1) scheme->advance(model, state, 1);
  EXPECT_EQ(state.time, 1);
  return std::hypot(net(state.x)(0, 0) - std::cos(1.0), net(state.x)(0, 1) - 0.5);
}

double observed_order(const std::string& scheme, double rate, double step = 0.04) {
  return std::log2(error_at_one(with(scheme), step, rate) / error_at_one(with(scheme), step / 2, rate));
}

// Orders are tested to 0.15, because the next term of the error is of relative size dt.
TEST(Integrators, TrBdf2IsOfThirdOrder) { EXPECT_NEAR(observed_order("tr-bdf2", 2, 0.02), 3, 0.15); }
TEST(Integrators, Bs3IsOfThirdOrder) { EXPECT_NEAR(observed_order("bs3", 2), 3, 0.15); }
TEST(Integrators, Bdf3IsOfThirdOrder) { EXPECT_NEAR(observed_order("bdf3", 2, 0.02), 3, 0.15); }
TEST(Integrators, Rkc2IsOfSecondOrder) { EXPECT_NEAR(observed_order("rkc2", 2), 2, 0.15); }
TEST(Integrators, CrankNicolsonIsOfSecondOrder) { EXPECT_NEAR(observed_order("crank-nicolson", 2), 2, 0.15); }

/// Model with an explicit clock: x' = -2 (x - c(t)) + c'(t), y' = -y c(t), so x = c, y = exp(-int c), with c = cos t before the kink, then cos t - 1.
class Clocked : public Model {
 public:
  using Model::velocity, Model::solve;
  static constexpr double kink = 0.3;
  Clocked() : Model(2) {}
  void set_time(double time, double start) override { time_ = time, jumped_ = start >= kink; }
  double next_kink(double time) const override { return time < kink ? kink : Model::next_kink(time); }
  Net velocity(const Net& x) override {
    const double c = std::cos(time_) - jumped_;
    Net v(1, 3);
    v << -2 * (x(0, 0) - c) - std::sin(time_), -x(0, 1) * c, 0;
    return v;
  }
  Net solve(double shift, const Net& r, double, const coupling::Secants&) override {
    Net delta = r;
    delta(0, 0) /= 1 + 2 * shift;
    delta(0, 1) /= 1 + shift * (std::cos(time_) - jumped_);
    return delta;
  }
  static Vec3 at_one() { return {std::cos(1.0) - 1 + std::exp(-2 * (1 - kink)), std::exp(-std::sin(1.0) + 1 - kink), 0}; }

 private:
  double time_ = 0;
  bool jumped_ = false;
};

double clocked_error(const std::string& scheme, double step) {
  TimeOptions options = with(scheme);
  options.fixed_step = step;
  Clocked model;
  TimeState state = start(step);
  const auto integrate = integrator(options);
  bool landed = false;
  while (state.time < 1) {
    integrate->advance(model, state, 1);
    landed = landed || state.time == Clocked::kink;
  }
  EXPECT_TRUE(landed) << scheme;
  return (state.x.numbers() - Clocked::at_one()).norm();
}

TEST(Integrators, KeepTheirOrderForMotionsThatVaryInTimeAndJump) {
  const std::pair<const char*, double> orders[] = {{"tr-bdf2", 3}, {"bs3", 3}, {"bdf3", 3}, {"rkc2", 2}, {"crank-nicolson", 2}, {"auto", 3}};
  EXPECT_EQ(std::size(orders), schemes.size());
  for (const auto& [scheme, order] : orders)
    EXPECT_NEAR(std::log2(clocked_error(scheme, 0.005) / clocked_error(scheme, 0.0025)), order, 0.15) << scheme;
}

TEST(Integrators, EverySolverOfCrankNicolsonFindsTheSameSteps) {
  TimeOptions options = with("crank-nicolson");
  const double plain = error_at_one(options, 0.02, 2);
  for (const char* solver : {"anderson", "newton-krylov"}) {
    options.nonlinear_solver = solver;
    options.newton_tolerance = 1e-5;                          // relative to Time/tolerance, which is 1e-4
    EXPECT_NEAR(error_at_one(options, 0.02, 2), plain, 1e-7) << solver;  // fifty steps, each with an error of 1e-9
  }
}

TEST(Integrators, SecantsSaveEvaluationsWithoutChangingTheResult) {
  for (const char* scheme : {"tr-bdf2", "bdf3"}) {
    int evaluations[2];
    State end[2];
    for (const int used : {0, 1}) {
      TimeOptions options = with(scheme);
      options.fixed_step = 0.1;
      options.secants = 3 * used;
      options.newton_iterations = 30;
      Incomplete model(20);
      TimeState state = start(0.1);
      const auto integrate = integrator(options);
      while (state.time < 1) integrate->advance(model, state, 1);
      evaluations[used] = model.evaluations;
      end[used] = state.x;
    }
    EXPECT_LT(evaluations[1], 0.8 * evaluations[0]) << scheme;
    EXPECT_LT(State(end[1] - end[0]).norm(), 1e-8) << scheme;  // ten steps, solved to 1e-10
  }
}

// The extrapolation (4.30) needs no exact Jacobian: the part that the Jacobian neglects changes the error only at fourth order.
TEST(Integrators, TrBdf2IsOfThirdOrderForAnIncompleteJacobian) {
  const auto error = [](double step) {
    TimeOptions options = with("tr-bdf2");
    options.fixed_step = step;
    options.newton_iterations = 100;
    Incomplete model(2);
    TimeState state = start(step);
    const auto scheme = integrator(options);
    while (state.time < 1) scheme->advance(model, state, 1);
    return std::hypot(net(state.x)(0, 0) - std::cos(1.0), net(state.x)(0, 1) - 0.5);
  };
  EXPECT_NEAR(std::log2(error(0.02) / error(0.01)), 3, 0.15);
}

/// Model x' = -x for all three coordinates, with an incomplete Jacobian, so that corrections contract at a known rate.
class Linear : public Model {
 public:
  using Model::velocity, Model::solve, Model::linearise;
  explicit Linear(double known) : Model(1), known_(known) {}
  Net velocity(const Net& x) override { return -x; }
  void linearise(const Net&) override {}
  Net solve(double shift, const Net& r, double, const coupling::Secants&) override { return r / (1 + shift * known_); }

 private:
  double known_;
};

TEST(QuasiNewton, TheErrorOfAStageIsMeasuredAndBounded) {
  for (const double known : {1.0, 0.5, 0.0, -0.5}) {
    Linear model(known);
    TimeOptions options;
    options.tolerance = 1e-3, options.secants = 0, options.newton_iterations = 50;
    const double shift = 0.4;
    const State rhs = state_of(Net::Ones(1, 3)), exact = rhs / (1 + shift);
    for (const double start : {1.0, 1e-3, 1e-4, 1e-5}) {  // distance of the start to the solution
      Stage stage;
      stage.y = exact + start * rhs;
      coupling::Secants secants;
      solve(model, options, rhs, shift, secants, stage);
      ASSERT_TRUE(stage.solved);
      EXPECT_LE(model.norm(stage.y - exact), stage.error * (1 + 1e-9) + 1e-15) << known << " " << start;
      EXPECT_LT(stage.error, options.newton_tolerance * options.tolerance);
      EXPECT_EQ(stage.iterations > 1, start > 2e-5) << "one iteration is enough only if the first correction is below a tenth of the allowed error";
    }
  }
}

/// Returns the distance from the slow solution after `steps` steps of 0.1. The first step starts far from this solution.
double transient(const std::string& scheme, double rate, int steps) {
  TimeOptions options = with(scheme);
  options.fixed_step = 0.1;
  options.predictor_order = 0;  // slopes of the transient are poor predictions
  Model model(rate);
  TimeState state = start(0.1);
  state.x.numbers()[0] = 3;
  const auto integrate = integrator(options);
  for (int k = 0; k < steps; ++k) integrate->advance(model, state, 10);
  return std::abs(net(state.x)(0, 0) - std::cos(net(state.x)(0, 2)));
}

TEST(Integrators, ImplicitSchemesDampAStiffTransient) {
  EXPECT_LT(transient("tr-bdf2", 1e8, 2), 1e-6);  // L-stable: divided by about dt rate each step
  EXPECT_LT(transient("bdf3", 1e8, 6), 1e-6);     // three steps of TR-BDF2, then three positions without the transient
}

TEST(Integrators, Rkc2UsesTheNumberOfStagesThatStabilityRequires) {
  EXPECT_EQ(rkc2_stages(0.1, 0), 2);
  for (const double rho : {10.0, 1e2, 1e3, 1e4}) {
    const double s = rkc2_stages(0.1, rho);
    EXPECT_LE(0.1 * rho, 0.653 * (s * s - 1) + 0.01);  // (4.8); 1/1.54 = 0.649
    EXPECT_LT(s, 2 + std::sqrt(1 + 1.54 * 0.1 * rho));
    // Each step multiplies the transient by at most 0.95, so that less than 1e-3 of it remains. The rest is the error of order dt^2 of the slow
    // solution.
    EXPECT_LT(transient("rkc2", rho, 150), 0.02);
  }
}

TEST(Integrators, Bs3IsUnstableJustBeyondItsBound) {
  EXPECT_LT(transient("bs3", 2.4 / 0.1, 100), 0.1);
  EXPECT_GT(transient("bs3", 2.6 / 0.1, 100), 10);
}

TEST(Integrators, TheStiffnessIsFoundFromARandomDirection) {
  Model model(40);
  State direction;
  const State x = start(0).x;
  EXPECT_NEAR(stiffness(model, x, model.velocity(x), direction, 8), 40, 0.5);  // the other eigenvalues are 0 and -2
  EXPECT_NEAR(stiffness(model, x, model.velocity(x), direction, 1), 40, 0.1);  // starts from the direction of the last call
}

TEST(Integrators, AutoIsExplicitIfThatIsStableAndImplicitOtherwise) {
  for (const double rate : {1.0, 1e4}) {
    TimeOptions options = with("auto");
    Model model(rate);
    TimeState state = start(1e-3);
    const auto scheme = integrator(options);
    int steps = 0;
    for (; state.time < 1; ++steps) scheme->advance(model, state, 1);
    EXPECT_LT(std::abs(net(state.x)(0, 1) - 0.5), steps * options.tolerance);
    EXPECT_FALSE(state.frozen.empty());
    EXPECT_LT(steps, 60) << rate;  // BS3 would take 4000 steps at the second rate
    EXPECT_EQ(model.solves > 0, rate > 1e3);
  }
}

TEST(Integrators, AutoMakesFixedStepsThatAreTooLongForExplicitSchemesImplicitly) {
  for (const double product : {2.7, 5.0}) {  // of step and stiffness; BS3 is stable up to 2.51
    TimeOptions options = with("auto");
    options.fixed_step = 0.1;
    Model model(product / 0.1);
    TimeState state = start(0.1);
    const auto scheme = integrator(options);
    while (state.time < 20) scheme->advance(model, state, 20);
    EXPECT_NEAR(net(state.x)(0, 0), std::cos(20.0), 1e-2) << product;
    EXPECT_GT(model.solves, 100) << product;
  }
}

TEST(Integrators, TheFirstStepIsNotShorterThanTheLeast) {
  Model model(30);
  TimeState state = start(0);
  state.history = {model.velocity(state.x)};
  TimeOptions options = with("tr-bdf2");
  options.final_time = 1;
  options.minimum_step = 0.1;
  EXPECT_EQ(first_step(model, state, options), 0.1);
}

/// Model in a lattice that moves. Records the time that was set when the operators were assembled.
class InLattice : public Model {
 public:
  using Model::Model;
  void set_time(double time, double /*start*/) override { now = time; }
  bool lattice_moves() const override { return true; }
  void freeze(const State& x) override {
    Model::freeze(x);
    assembled = now;
  }

  double now = 0, assembled = 0;
};

TEST(Integrators, FrozenOperatorsUseTheLatticeAtTheTimeOfAssembly) {
  InLattice model(1);
  TimeState state = start(0.25);
  state.time = 0.5;
  state.frozen = state_of(Net::Zero(1, 3));
  Stage last;  // not solved
  last.time = model.now = 0.75;
  coupling::Secants secants;
  judge(model, with("tr-bdf2"), state, secants, last, 0, 3, {});
  EXPECT_EQ(model.assembled, 0.5);
  EXPECT_EQ(model.now, 0.75);
  model.now = 0;  // as in a new system
  refreeze(model, state, state.time);
  EXPECT_EQ(model.assembled, 0.5);
  EXPECT_EQ(model.assemblies, 2);
}

TEST(Integrators, AutoMakesAFirstStepThatIsTooLongForExplicitSchemes) {
  for (const double rate : {1.0, 1e4}) {
    Model model(rate);
    TimeState state = start(1e-2);
    integrator(with("auto"))->advance(model, state, 1);
    EXPECT_EQ(model.solves > 0, rate > 1e3);
    EXPECT_NEAR(state.time, 1e-2, 1e-12) << rate;
  }
}

TEST(Integrators, AutoAssemblesNoOperatorAboveTheMemoryLimit) {
  TimeOptions options = with("auto");
  options.largest_operator = 1e-9;  // in GB; the operator has 12 bytes
  Model model(1e3);
  TimeState state = start(1e-3);
  const auto scheme = integrator(options);
  while (state.time < 0.2) scheme->advance(model, state, 0.2);
  EXPECT_EQ(model.assemblies, 0);
  EXPECT_EQ(model.solves, 0);
}

// For steps of the smooth motion x = sin t, the interpolation error of the cubic is dt^4/384; that of its slope is of third order.
TEST(DenseOutput, IsOfFourthOrderAndItsSlopeOfThird) {
  const auto errors = [](double step) {
    const auto at = [](double time) {
      TimeState state;
      state.time = time;
      state.x = state_of(Net::Constant(1, 3, std::sin(time)));
      state.history = {state_of(Net::Constant(1, 3, std::cos(time)))};
      return state;
    };
    const DenseOutput dense(at(1), at(1 + step));
    EXPECT_EQ(dense.state(1).numbers()[0], std::sin(1.0));
    EXPECT_NEAR(dense.slope(1 + step).numbers()[0], std::cos(1 + step), 1e-14);
    const double time = 1 + 0.3 * step;  // not a point where the error of the slope vanishes
    return std::pair(std::abs(dense.state(time).numbers()[0] - std::sin(time)), std::abs(dense.slope(time).numbers()[0] - std::cos(time)));
  };
  const auto [place, slope] = errors(0.1);
  const auto [finer_place, finer_slope] = errors(0.05);
  EXPECT_NEAR(std::log2(place / finer_place), 4, 0.1);
  EXPECT_NEAR(std::log2(slope / finer_slope), 3, 0.1);
}

TEST(Integrators, ControlledStepsMeetTheToleranceAndGrow) {
  for (const char* scheme : {"tr-bdf2", "bdf3", "bs3", "rkc2", "auto"}) {
    double previous = 0;
    for (const double tolerance : {1e-4, 1e-6}) {
      TimeOptions options = with(scheme);
      options.tolerance = tolerance;
      Model model(2);
      TimeState state = start(1e-4);
      const auto integrate = integrator(options);
      int steps = 0;
      while (state.time < 1) {
        const StepReport report = integrate->advance(model, state, 1);
        EXPECT_LE(report.error, tolerance);
        ++steps;
      }
      // The problem damps errors, so the sum of `steps` local errors, each below the tolerance, bounds the global error.
      EXPECT_LT(std::hypot(net(state.x)(0, 0) - std::cos(1.0), net(state.x)(0, 1) - 0.5), std::sqrt(3.0) * steps * tolerance);
      EXPECT_GT(steps, previous);
      previous = steps;
    }
  }
}

TEST(Integrators, CrankNicolsonFollowsThePapersStepRule) {
  Model gentle(0.1), stiff(100);
  TimeState easy = start(1e-6), hard = start(0.04);  // 0.04 x 100 = 4 > 2: the sub-iteration diverges
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
  TimeState landing = start(1e-6);
  scheme->advance(gentle, landing, 5e-7);  // few sub-iterations as well, but the step was shortened to meet the limit
  EXPECT_DOUBLE_EQ(landing.step, 1e-6);
}

TEST(Integrators, AStepBelowTheMinimumEndsTheRunAndKeepsTheState) {
  class Broken : public Model {
   public:
    Broken() : Model(1) {}
    Net velocity(const Net&) override { return Net::Constant(1, 3, std::numeric_limits<double>::quiet_NaN()); }
  };
  for (const std::string& scheme : schemes) {
    TimeOptions options = with(scheme);
    options.minimum_step = 1e-5;
    Broken model;
    TimeState state = start(1e-3);
    state.history = {state_of(Net::Zero(1, 3))};
    const State before = state.x;
    EXPECT_THROW(integrator(options)->advance(model, state, 1), RunFailure) << scheme;
    EXPECT_TRUE(state.x == before);
    EXPECT_EQ(state.time, 0);
  }
}

/// The model in another unit of time, by the factor `unit`.
class Rescaled : public Model {
 public:
  using Model::velocity;
  explicit Rescaled(double unit) : Model(30), unit_(unit) {}
  Net velocity(const Net& x) override { return unit_ * Model::velocity(x); }

 private:
  double unit_;
};

TEST(Integrators, TheFirstStepDoesNotDependOnTheUnitOfTime) {
  double first = 0;
  for (const double unit : {1.0, 1e-3, 1e4}) {
    Rescaled model(unit);
    TimeState state = start(0);
    state.history = {model.velocity(state.x)};
    TimeOptions options = with("tr-bdf2");
    options.final_time = 1 / unit;
    const double step = unit * first_step(model, state, options);
    if (unit == 1) first = step;
    EXPECT_GT(step, 0);
    EXPECT_NEAR(step, first, 1e-9 * first) << unit;  // round-off of a difference quotient
  }
}

TEST(Integrators, AFixedStepMayBeShorterThanTheLeastOfAControlledOne) {
  TimeOptions options = with("bs3");
  options.fixed_step = 1e-12;
  Model model(1);
  TimeState state = start(1);
  EXPECT_EQ(integrator(options)->advance(model, state, 1).step, 1e-12);
}

TEST(Integrators, RepeatedStepsReduceTheErrorForAnyOrder) {
  const TimeOptions options;
  for (const double power : {3., 1., 0.7}) {
    TimeState state;
    state.step = 1;
    Attempts attempts(options, state, 100);
    const auto error = [&] { return 5 * std::pow(attempts.next(), power); };
    double last = error();
    for (; last > 1; last = error()) attempts.reject(std::min(0.8, step_factor(last, 0, 3)), last);
    EXPECT_LE(attempts.report.rejected, 2) << power;
    EXPECT_GT(last, 0.5) << power;  // not smaller than necessary: the safety factor is 0.9
  }
}

TEST(Integrators, RepeatedStepsAreNotShortenedTooMuchIfTheErrorHardlyDecreases) {
  const TimeOptions options;
  TimeState state;
  state.step = 1;
  Attempts attempts(options, state, 100);
  attempts.next();
  attempts.reject(0.8, 1.21);
  EXPECT_EQ(attempts.next(), 0.8);
  attempts.reject(0.8, 1.2);
  EXPECT_NEAR(attempts.next(), 0.8 * 0.9 / (1.2 * 1.2), 1e-14);
}

TEST(Integrators, StepsTowardsALimitLeaveNoTinyLastStep) {
  EXPECT_EQ(step_towards(1, 2, 5), 1);
  EXPECT_EQ(step_towards(1, 2, 0.7), 0.5);
  EXPECT_EQ(step_towards(1, 2, 0.3), 0.3);
}

TEST(Integrators, ACopiedStateContinuesBitwiseEqual) {
  for (const std::string& scheme : schemes) {
    Model model(3);
    TimeState state = start(0.01);
    const auto one = integrator(with(scheme));
    for (int k = 0; k < 5; ++k) one->advance(model, state, 1);
    TimeState copy = state;
    const auto other = integrator(with(scheme));
    for (int k = 0; k < 5; ++k) {
      one->advance(model, state, 1);
      other->advance(model, copy, 1);
    }
    EXPECT_TRUE(state.x == copy.x) << scheme;
    EXPECT_EQ(state.step, copy.step) << scheme;
  }
}

}  // namespace integrators_test
}  // namespace tanktread::motion
