// Tests of fixed-point iterations by NOX.

#include <cmath>
#include <limits>

#include <Teuchos_ParameterList.hpp>
#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "system/solvers/nonlinear.hpp"
#include "tests/states.hpp"

namespace tanktread::coupling {
namespace {

double norm(const State& x) { return x.norm(); }

/// Map of ten points that stretches by up to 1.5, so that the plain iteration diverges.
State stretched(const State& x) {
  State y = x;
  const Eigen::Index n = x.numbers().size();
  for (Eigen::Index i = 0; i < n; ++i) {
    const double rate = -1.5 * static_cast<double>(i + 1) / static_cast<double>(n);
    y.numbers()[i] = 1 + rate * x.numbers()[i] + 0.1 * std::sin(x.numbers()[i]);
  }
  return y;
}

TEST(FixedPoint, IsFoundIfPlainIterationDiverges) {
  const State start = state_of(Net::Zero(10, 3));
  State plain = start;
  for (int k = 0; k < 40; ++k) plain = stretched(plain);
  EXPECT_GT(norm(stretched(plain) - plain), 1);
  for (const char* method : {"anderson", "newton-krylov"}) {
    State x = start;
    int evaluations = 0;
    const auto g = [&](const State& y) {
      ++evaluations;
      return stretched(y);
    };
    const NonlinearReport report = FixedPoint(method, nullptr).solve(g, norm, 1e-8, 60, x);
    EXPECT_TRUE(report.converged) << method;
    EXPECT_LE(norm(stretched(x) - x), 1e-8) << method;
    EXPECT_GE(evaluations, report.iterations);
  }
}

TEST(FixedPoint, EndsUnconvergedAtTheLastIterationOrAtAValueThatIsNotFinite) {
  for (const char* method : {"anderson", "newton-krylov"}) {
    State x = state_of(Net::Zero(10, 3));
    EXPECT_FALSE(FixedPoint(method, nullptr).solve(stretched, norm, 1e-14, 1, x).converged) << method;
    const auto broken = [](const State& y) { return not_a_number(y); };
    EXPECT_FALSE(FixedPoint(method, nullptr).solve(broken, norm, 1e-8, 10, x).converged) << method;
  }
}

TEST(FixedPoint, DoesNotDependOnTheUnitOfLength) {
  constexpr double unit = 0x1p-60;
  const auto g = [&](const State& y) -> State { return unit * stretched(y / unit); };
  const auto in_unit = [&](const State& y) { return norm(y) / unit; };
  for (const char* method : {"anderson", "newton-krylov"}) {
    State x = state_of(Net::Zero(10, 3)), small = x;
    const NonlinearReport report = FixedPoint(method, nullptr).solve(stretched, norm, 1e-8, 60, x);
    const NonlinearReport same = FixedPoint(method, nullptr).solve(g, in_unit, 1e-8, 60, small);
    EXPECT_TRUE(same.converged) << method;
    EXPECT_EQ(same.iterations, report.iterations) << method;
    EXPECT_TRUE(small == State(unit * x)) << method;
  }
}

TEST(FixedPoint, ParametersThatNoxRejectsAreReported) {
  const auto list = std::make_shared<Teuchos::ParameterList>();
  list->sublist("Anderson Parameters").set("Storage Deep", 3);
  State x = state_of(Net::Zero(10, 3));
  EXPECT_THROW(FixedPoint("anderson", list).solve(stretched, norm, 1e-8, 10, x), UserError);
}

}  // namespace
}  // namespace tanktread::coupling
