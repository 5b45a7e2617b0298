// Tests that long computations answer a request to stop at once, on all ranks.

#include "system/parallel/stop_together.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "base/dense_factors.hpp"
#include "base/indices.hpp"
#include "spline/extraction.hpp"
#include "spline/t_mesh.hpp"
#include "surface/shapes.hpp"
#include "system/parallel/ranks.hpp"
#include "system/solvers/eigenvalues.hpp"
#include "system/solvers/krylov.hpp"
#include "system/solvers/nonlinear.hpp"
#include "tests/layers.hpp"
#include "tests/states.hpp"

namespace tanktread::coupling {
namespace {

/// A symmetric map of 60 numbers whose eigenvalues are between 0.5 and 1.5. In its third call, the last rank receives a request to stop.
class StopTogether : public testing::Test {
 protected:
  static constexpr int n = 60, last = 3;

  void SetUp() override {
    set_stop_request([this] { return requested_; });
  }
  void TearDown() override { set_stop_request({}); }

  Apply map() {
    return [this](const double* in, double* out) {
      if (++calls_ == last) requested_ = ranks_.rank() == ranks_.size() - 1;
      for (int i = 0; i < n; ++i) out[i] = (1 + 0.3 * std::cos(i)) * in[i] + 0.1 * (in[(i + 1) % n] + in[(i + n - 1) % n]);
    };
  }

  void solve(const IterativeOptions& options) {
    Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
    Krylov(options).solve({one_block("unknowns", n), map(), {}}, Eigen::VectorXd::Ones(n), x, 1e-10);
    EXPECT_TRUE(x.allFinite());
  }

  void find_fixed_point(const char* method) {
    State x = state_of(Net::Zero(n / 3, 3));
    const auto g = [product = map(), one = state_of(Net::Ones(n / 3, 3))](const State& y) -> State {
      State image = y;
      product(y.numbers().data(), image.numbers().data());
      return 0.5 * image + one;
    };
    EXPECT_TRUE(FixedPoint(method, nullptr).solve(g, [](const State& y) { return y.norm(); }, 1e-10, 50, x).converged);
  }

  /// Checks that no product follows the request, that the request is answered once, and that the computation runs to its end afterwards.
  /// `more`: number of evaluations of the map that are no products and may follow the request.
  template <class Act>
  void expect_stop(const Act& act, int more = 0) {
    calls_ = 0, requested_ = false;
    set_stop_request([this] { return requested_; });
    EXPECT_THROW(act(), Stopped);
    EXPECT_EQ(calls_, last + more);
    EXPECT_NO_THROW(act());
    EXPECT_GT(calls_, 2 * last);
  }

  Ranks ranks_;
  int calls_ = 0;
  bool requested_ = false;
};

TEST_F(StopTogether, NoProductOfALinearSolveFollowsTheRequest) {
  for (const std::string& solver : Krylov::names())
    for (const char* preconditioner : {"own", "recycled"}) {
      SCOPED_TRACE(solver + " " + preconditioner);
      expect_stop([&] { solve({.solver = solver, .preconditioner = preconditioner}); });
    }
}

// Newton's method forms products of its Jacobian in a linear solve, and evaluates the map between two solves. Anderson's method is stopped by the
// evaluations themselves (GuardedDynamics).
TEST_F(StopTogether, NoProductOfNewtonsMethodFollowsTheRequest) {
  expect_stop([&] { find_fixed_point("newton-krylov"); }, 1);
}

TEST_F(StopTogether, NoProductOfAnEigensolverFollowsTheRequest) {
  expect_stop([&] { largest_eigenpairs(map(), n, 2, 1, 1e-6); });
}

// The work of the last rank ends early, and no rank waits for another.
TEST_F(StopTogether, WorkOfOneRankEndsEarly) {
  int blocks = 0;
  requested_ = ranks_.rank() == ranks_.size() - 1;
  const auto work = [&] {
    for (int k = 0; k < 10; ++k) stop_here(), ++blocks;
  };
  EXPECT_THROW(stop_together(work), Stopped);
  EXPECT_EQ(blocks, requested_ ? 0 : 10);
  EXPECT_NO_THROW(stop_together(work));
}

TEST_F(StopTogether, OneOfSeveralRanksDoesNotStopAlone) {
  requested_ = true;
  if (ranks_.size() == 1) EXPECT_THROW(stop_here(), Stopped);
  else EXPECT_NO_THROW(stop_here());
}

TEST_F(StopTogether, NothingStopsWhileResultsAreWritten) {
  requested_ = true;
  {
    const Meanwhile complete(stop_rules().answers, false);
    EXPECT_NO_THROW(stop_together());
  }
  EXPECT_THROW(stop_together(), Stopped);
}

TEST_F(StopTogether, AFactorisationAndAnAssemblyStopBetweenTheirBlocks) {
  int polls = 0;
  set_stop_request([&] { return ++polls == 2; });
  EXPECT_THROW(stop_together([] { DenseFactors(Eigen::MatrixXd::Identity(200, 200)); }), Stopped);  // four panels
  EXPECT_EQ(polls, 2);
  const spline::TMesh mesh = spline::cube(3);
  const spline::Space space = spline::space(mesh, spline::ExtraordinaryRule::g1);
  stokes::SingleLayer layer(space, {});
  layer.set_shape(surface::resting_shape(space, mesh, {}));
  stokes::Rows<double> rows;
  polls = 0;
  set_stop_request([&] { return ++polls == 2; });
  EXPECT_THROW(stop_together([&] { static_cast<stokes::Layer&>(layer).assemble(indices(space.n_points), rows); }), Stopped);
  EXPECT_EQ(polls, 2);
}

}  // namespace
}  // namespace tanktread::coupling
