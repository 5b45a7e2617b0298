// Tests of fixed-point iterations by NOX.

#include <cmath>
#include <limits>

#include <Teuchos_ParameterList.hpp>
#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "system/solvers/nonlinear.hpp"

namespace tanktread::coupling {
namespace {

double norm(const Net& x) { return x.norm(); }

/// Map of ten points that stretches by up to 1.5, so that the plain iteration diverges.
Net stretched(const Net& x) {
  Net y = x;
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double rate = -1.5 * static_cast<double>(i + 1) / static_cast<double>(x.size());
    y.data()[i] = 1 + rate * x.data()[i] + 0.1 * std::sin(x.data()[i]);
  }
  return y;
}

TEST(FixedPoint, IsFoundIfPlainIterationDiverges) {
  const Net start = Net::Zero(10, 3);
  Net plain = start;
  for (int k = 0; k < 40; ++k) plain = stretched(plain);
  EXPECT_GT(norm(stretched(plain) - plain), 1);
  for (const char* method : {"anderson", "newton-krylov"}) {
    Net x = start;
    int evaluations = 0;
    const auto g = [&](const Net& y) {
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
    Net x = Net::Zero(10, 3);
    EXPECT_FALSE(FixedPoint(method, nullptr).solve(stretched, norm, 1e-14, 1, x).converged) << method;
    const auto broken = [](const Net& y) -> Net { return Net::Constant(y.rows(), 3, std::numeric_limits<double>::quiet_NaN()); };
    EXPECT_FALSE(FixedPoint(method, nullptr).solve(broken, norm, 1e-8, 10, x).converged) << method;
  }
}

TEST(FixedPoint, DoesNotDependOnTheUnitOfLength) {
  constexpr double unit = 0x1p-60;
  const auto g = [&](const Net& y) -> Net { return unit * stretched(y / unit); };
  const auto in_unit = [&](const Net& y) { return norm(y) / unit; };
  for (const char* method : {"anderson", "newton-krylov"}) {
    Net x = Net::Zero(10, 3), small = x;
    const NonlinearReport report = FixedPoint(method, nullptr).solve(stretched, norm, 1e-8, 60, x);
    const NonlinearReport same = FixedPoint(method, nullptr).solve(g, in_unit, 1e-8, 60, small);
    EXPECT_TRUE(same.converged) << method;
    EXPECT_EQ(same.iterations, report.iterations) << method;
    EXPECT_TRUE(small == unit * x) << method;
  }
}

TEST(FixedPoint, ParametersThatNoxRejectsAreReported) {
  const auto list = std::make_shared<Teuchos::ParameterList>();
  list->sublist("Anderson Parameters").set("Storage Deep", 3);
  Net x = Net::Zero(10, 3);
  EXPECT_THROW(FixedPoint("anderson", list).solve(stretched, norm, 1e-8, 10, x), UserError);
}

}  // namespace
}  // namespace tanktread::coupling
