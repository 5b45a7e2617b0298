// Tests of the interface to the solvers of Belos, on any number of ranks.

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>

#include <Eigen/LU>
#include <Teuchos_ParameterList.hpp>
#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "system/parallel/agreement.hpp"
#include "system/parallel/ranks.hpp"
#include "system/solvers/krylov.hpp"

namespace tanktread::coupling {
namespace {

Eigen::MatrixXd nonsymmetric(int n) {
  Eigen::MatrixXd a(n, n);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) a(i, j) = (i == j ? 3 : 0) + std::sin(1.0 + i + 2 * j) / n;
  return a;
}

SolveReport solve(const Krylov& krylov, const Apply& apply, const Eigen::VectorXd& b, Eigen::VectorXd& x, double tolerance,
                  const Apply& precondition = {}) {
  return krylov.solve({one_block("unknowns", b.size()), apply, precondition}, b, x, tolerance);
}

TEST(Krylov, SolvesANonsymmetricSystemToTheTolerance) {
  const int n = 60;
  const Eigen::MatrixXd a = nonsymmetric(n);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(n, -1, 2);
  const Apply apply = [&](const double* in, double* out) {
    Eigen::Map<Eigen::VectorXd>(out, n) = a * Eigen::Map<const Eigen::VectorXd>(in, n);
  };
  for (const char* name : {"GMRES", "BICGSTAB"})
    for (const double tolerance : {1e-3, 1e-10}) {
      Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
      const SolveReport report = solve(Krylov({name}), apply, b, x, tolerance);
      EXPECT_TRUE(report.converged);
      EXPECT_GT(report.iterations, 0);
      EXPECT_LT((a * x - b).norm(), 2 * tolerance * b.norm()) << name;  // Belos computes this residual by recurrence
    }
}

TEST(Krylov, TheInverseAsPreconditionerNeedsOneIteration) {
  const int n = 60;
  const Eigen::MatrixXd a = nonsymmetric(n), inverse = a.inverse();
  const auto product = [](const Eigen::MatrixXd& m) {
    return [&m](const double* in, double* out) { Eigen::Map<Eigen::VectorXd>(out, n) = m * Eigen::Map<const Eigen::VectorXd>(in, n); };
  };
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(n, -1, 2);
  for (const char* name : {"GMRES", "BICGSTAB"}) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    const SolveReport report = solve(Krylov({name}), product(a), b, x, 1e-10, product(inverse));
    EXPECT_TRUE(report.converged) << name;
    EXPECT_EQ(report.iterations, 1) << name;
    EXPECT_LT((a * x - b).norm(), 1e-10 * b.norm()) << name;
  }
}

TEST(Krylov, MultipliesOncePerIteration) {
  const int n = 60;
  const Eigen::MatrixXd a = nonsymmetric(n);
  int products = 0;
  const Apply apply = [&](const double* in, double* out) {
    Eigen::Map<Eigen::VectorXd>(out, n) = a * Eigen::Map<const Eigen::VectorXd>(in, n);
    ++products;
  };
  const Krylov krylov({"GMRES"});
  for (const double tolerance : {1e-3, 1e-8}) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    products = 0;
    EXPECT_EQ(solve(krylov, apply, Eigen::VectorXd::LinSpaced(n, -1, 2), x, tolerance).iterations, products);
  }
}

TEST(Krylov, ReportsAnIterationThatDidNotConverge) {
  const int n = 40;
  const Apply shift = [&](const double* in, double* out) {  // a cyclic shift: GMRES makes no progress before iteration n
    for (int i = 0; i < n; ++i) out[i] = in[(i + 1) % n];
  };
  Eigen::VectorXd b = Eigen::VectorXd::Unit(n, 0), x = Eigen::VectorXd::Zero(n);
  const Krylov krylov({"GMRES"});
  EXPECT_TRUE(solve(krylov, shift, b, x, 1e-8).converged);
  const Apply singular = [&](const double*, double* out) { std::fill(out, out + n, 0.0); };
  x.setZero();
  const SolveReport report = solve(krylov, singular, b, x, 1e-8);
  EXPECT_FALSE(report.converged);
  EXPECT_THROW(require_convergence(report, "nothing", 1e-8), RunFailure);
}

TEST(Krylov, ReportsTheResidualOfEachBlockIfItDidNotConverge) {
  const int n = 60;
  const Eigen::MatrixXd a = nonsymmetric(n);
  const Apply apply = [&](const double* in, double* out) {
    Eigen::Map<Eigen::VectorXd>(out, n) = a * Eigen::Map<const Eigen::VectorXd>(in, n);
  };
  const auto list = std::make_shared<Teuchos::ParameterList>();
  list->set("Maximum Iterations", 1);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(n, -1, 2);
  for (const char* name : {"GMRES", "Block GMRES", "BICGSTAB"}) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    const std::vector<Block> blocks = {{.name = "velocity", .rows = n - 1, .components = 1}, {.name = "pressure drop", .rows = 1, .components = 1}};
    const SolveReport report = Krylov({name, list}).solve({blocks, apply, {}}, b, x, 1e-10);
    EXPECT_EQ(report.iterations, 1) << name;
    ASSERT_EQ(report.residuals.size(), 2u) << name;
    EXPECT_NEAR(report.residuals[0].second, (a * x - b).head(n - 1).norm() / b.norm(), 1e-14) << name;
    EXPECT_NEAR(report.residuals[1].second, std::abs((a * x - b)[n - 1]) / b.norm(), 1e-14) << name;
    try {
      require_convergence(report, "both", 1e-10);
      FAIL() << name;
    } catch (const RunFailure& failure) {
      EXPECT_NE(std::string(failure.what()).find("of the pressure drop"), std::string::npos) << failure.what();
    }
  }
}

// Blocks only name parts of the array, so that they do not change the solution.
TEST(Krylov, SolvesTheSameInOneBlockAndInSeveral) {
  const int n = 60;
  const Eigen::MatrixXd a = nonsymmetric(n);
  const Apply apply = [&](const double* in, double* out) {
    Eigen::Map<Eigen::VectorXd>(out, n) = a * Eigen::Map<const Eigen::VectorXd>(in, n);
  };
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(n, -1, 2);
  for (const std::string& name : Krylov::names()) {
    if (name.find("CG") != std::string::npos || name == "MINRES" || name == "FIXED POINT") continue;  // methods for symmetric systems, or for small
                                                                                                      // ones
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n), y = x;
    const Krylov krylov({name});
    const std::vector<Block> several = {
        {.name = "one", .rows = 20, .components = 2}, {.name = "two", .rows = 19, .components = 1}, {.name = "three", .rows = 1, .components = 1}};
    EXPECT_TRUE(krylov.solve({one_block("all", n), apply, {}}, b, x, 1e-10).converged) << name;
    EXPECT_TRUE(krylov.solve({several, apply, {}}, b, y, 1e-10).converged) << name;
    EXPECT_LT((a * x - b).norm(), 2e-10 * b.norm()) << name;
    EXPECT_LT((x - y).norm(), 1e-12 * x.norm()) << name;
  }
}

// A preconditioner changes the iterations, but not the solution.
TEST(Krylov, EveryPreconditionerLeadsToTheSolution) {
  const int n = 60;
  Eigen::MatrixXd a = nonsymmetric(n);
  a.diagonal() += Eigen::VectorXd::LinSpaced(n, 0, 2);
  const Apply apply = [&](const double* in, double* out) {
    Eigen::Map<Eigen::VectorXd>(out, n) = a * Eigen::Map<const Eigen::VectorXd>(in, n);
  };
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(n, -1, 2);
  for (const char* name : {"GMRES", "BICGSTAB", "TFQMR"}) {
    std::map<std::string, int> iterations;
    for (const char* preconditioner : {"own", "none", "recycled"}) {
      const Krylov krylov(IterativeOptions{name, nullptr, preconditioner});
      for (int repeated = 0; repeated < 2; ++repeated) {
        Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
        const SolveReport report = krylov.solve({one_block("unknowns", n), apply, {}}, b, x, 1e-6);
        EXPECT_TRUE(report.converged) << name << ", " << preconditioner;
        EXPECT_LT((a * x - b).norm(), 2e-6 * b.norm()) << name << ", " << preconditioner;
        iterations[preconditioner] = report.iterations;
      }
    }
    EXPECT_EQ(iterations["own"], iterations["none"]) << name;
    EXPECT_LE(iterations["recycled"], 1) << name;  // the solution is a linear combination of recorded products
  }
}

// A run that is resumed from a checkpoint does not know the products of earlier solves. An uninterrupted run must therefore discard them, too.
TEST(Krylov, DiscardsRecycledProducts) {
  const int n = 60;
  const Eigen::MatrixXd a = nonsymmetric(n);
  const Apply apply = [&](const double* in, double* out) {
    Eigen::Map<Eigen::VectorXd>(out, n) = a * Eigen::Map<const Eigen::VectorXd>(in, n);
  };
  const Krylov krylov(IterativeOptions{"GMRES", nullptr, "recycled"});
  const auto solved = [&] {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    const int iterations = krylov.solve({one_block("unknowns", n), apply, {}}, Eigen::VectorXd::LinSpaced(n, -1, 2), x, 1e-6).iterations;
    return std::pair(iterations, x);
  };
  const auto [iterations, x] = solved();
  EXPECT_LT(solved().first, iterations);
  Krylov::forget_recycled();
  const auto [again, y] = solved();
  EXPECT_EQ(again, iterations);
  EXPECT_EQ(y, x);  // equal to the last bit
}

TEST(Krylov, ValuesThatAreNotFiniteCountAsNotConverged) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const Apply broken = [&](const double* in, double* out) { std::fill(out, out + 5, nan * in[0]); };
  for (const char* name : {"GMRES", "BICGSTAB", "TFQMR"}) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(5);
    EXPECT_FALSE(solve(Krylov({name}), broken, Eigen::VectorXd::Ones(5), x, 1e-8).converged) << name;
    x.setZero();
    EXPECT_FALSE(solve(Krylov({name}), [](const double*, double*) {}, Eigen::VectorXd::Constant(5, nan), x, 1e-8).converged) << name;
  }
}

// Ranks stop in one iteration even if their products differ by more than round-off.
TEST(Krylov, EndsInTheSameIterationOnAllRanks) {
  const int n = 60;
  const Ranks ranks;
  const Eigen::MatrixXd a = nonsymmetric(n) * (1 + 0.3 * ranks.rank()) + ranks.rank() * Eigen::MatrixXd::Identity(n, n);
  const Apply apply = [&](const double* in, double* out) {
    Eigen::Map<Eigen::VectorXd>(out, n) = a * Eigen::Map<const Eigen::VectorXd>(in, n);
  };
  for (const char* name : {"GMRES", "BICGSTAB"}) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    const int iterations = solve(Krylov({name}), apply, Eigen::VectorXd::LinSpaced(n, -1, 2), x, 1e-6).iterations;
    EXPECT_EQ(iterations, of_first(static_cast<double>(iterations))) << name;
  }
}

// The residual is relative to the right-hand side, not to the initial residual, which may be round-off only.
TEST(Krylov, AnInitialGuessThatIsTheSolutionIsNotChanged) {
  const int n = 60;
  const Eigen::MatrixXd a = nonsymmetric(n);
  const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(n, -1, 2), solution = a.partialPivLu().solve(b);
  const Apply apply = [&](const double* in, double* out) {
    Eigen::Map<Eigen::VectorXd>(out, n) = a * Eigen::Map<const Eigen::VectorXd>(in, n);
  };
  for (const char* name : {"GMRES", "Flexible GMRES", "BICGSTAB", "TFQMR"}) {
    Eigen::VectorXd x = solution;
    const SolveReport report = solve(Krylov({name}), apply, b, x, 1e-8);
    EXPECT_TRUE(report.converged) << name;
    EXPECT_LE(report.iterations, 1) << name;
    EXPECT_LT((x - solution).norm(), 1e-8 * solution.norm()) << name;
  }
}

TEST(Krylov, ZeroRightHandSideNeedsNoIteration) {
  Eigen::VectorXd x = Eigen::VectorXd::Ones(5);
  const SolveReport report = solve(Krylov({"GMRES"}), [](const double*, double*) { FAIL(); }, Eigen::VectorXd::Zero(5), x, 1e-8);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(x.norm(), 0);
}

TEST(Krylov, ASolverThatBelosDoesNotKnowIsRejected) { EXPECT_THROW(Krylov({"WISHFUL"}), UserError); }

}  // namespace
}  // namespace tanktread::coupling
