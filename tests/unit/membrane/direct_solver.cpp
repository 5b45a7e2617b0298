#include "membrane/direct_solver.hpp"

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/SparseLU>
#include <Teuchos_ParameterList.hpp>

#include "base/errors.hpp"

namespace tanktread::membrane {
namespace {

/// Returns a banded matrix, symmetric positive definite if skew = 0.
Eigen::SparseMatrix<double> banded(int n, double diagonal, double skew) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i)
    for (int j = std::max(0, i - 4); j <= std::min(n - 1, i + 4); ++j)
      entries.emplace_back(i, j, i == j ? diagonal : 1 / (1. + std::abs(i - j)) + skew * (i - j));
  Eigen::SparseMatrix<double> a(n, n);
  a.setFromTriplets(entries.begin(), entries.end());
  return a;
}

Net right_hand_side(int n) {
  Net b(n, 3);
  for (int i = 0; i < b.size(); ++i) b.data()[i] = std::cos(3. * i);
  return b;
}

DirectSolverOptions named(const std::string& name) {
  DirectSolverOptions options;
  options.name = name;
  return options;
}

DirectSolverOptions by(const std::string& way) {
  DirectSolverOptions options;
  options.sparse_systems = way;
  return options;
}

TEST(DirectSolver, IterationAgreesWithFactorisation) {
  for (const double skew : {0., 0.3}) {
    const auto a = banded(1000, 5, skew);
    const Net b = right_hand_side(1000);
    DirectSolver direct(by("direct")), iterative(by("iterative"));
    direct.factor(a), iterative.factor(a);
    EXPECT_LT((direct.solve(b) - iterative.solve(b)).norm(), 1e-12 * direct.solve(b).norm()) << skew;
    EXPECT_GT((direct.solve(b) - iterative.solve(b)).norm(), 0) << "the same solver twice";
  }
}

/// Returns a block-diagonal matrix.
Eigen::SparseMatrix<double> stacked(const std::vector<Eigen::SparseMatrix<double>>& blocks) {
  std::vector<Eigen::Triplet<double>> entries;
  int first = 0;
  for (const Eigen::SparseMatrix<double>& block : blocks) {
    for (int j = 0; j < block.outerSize(); ++j)
      for (Eigen::SparseMatrix<double>::InnerIterator entry(block, j); entry; ++entry)
        entries.emplace_back(first + static_cast<int>(entry.row()), first + j, entry.value());
    first += static_cast<int>(block.rows());
  }
  Eigen::SparseMatrix<double> all(first, first);
  all.setFromTriplets(entries.begin(), entries.end());
  return all;
}

/// Blocks of three kinds. Two kinds have the same pattern, and one block equals others only up to round-off. The blocks have a size that is inverted
/// (60) and one that is not (300).
TEST(DirectSolver, OfEqualBlocksSolvesAsOfOneMatrix) {
  for (const int n : {60, 300})
    for (const double skew : {0., 0.3}) {
      const Eigen::SparseMatrix<double> one = banded(n, 5, skew), other = banded(n, 6, skew), smaller = banded(n - 7, 5, skew);
      const auto a = stacked({one, other, one, smaller, (1 + 1e-15) * one, other, smaller, one});
      const Net b = right_hand_side(static_cast<int>(a.rows()));
      DirectSolver solver;
      solver.factor(a);
      EXPECT_LT((a * solver.solve(b) - b).norm(), 1e-13 * b.norm()) << n;  // round-off
      const auto changed = stacked({one, 1.01 * one, 1.02 * one, one});    // half of the blocks are not equal to any other
      solver.factor(changed);
      const Net c = b.topRows(changed.rows());
      EXPECT_LT((changed * solver.solve(c) - c).norm(), 1e-13 * c.norm()) << n;
    }
}

/// Cyclic shift of a vector: its incomplete factors are useless, its complete factors are exact.
TEST(DirectSolver, AMatrixThatIterationDoesNotSolveIsFactored) {
  const int n = 400;
  Eigen::SparseMatrix<double> shift(n, n);
  for (int i = 0; i < n; ++i) shift.insert(i, (i + 1) % n) = 1;
  DirectSolver solver(by("iterative"));
  solver.factor(shift);
  const Net b = right_hand_side(n);
  EXPECT_LT((shift * solver.solve(b) - b).norm(), 1e-12);
}

TEST(DirectSolver, AgreesWithEigenOnSymmetricAndOtherMatrices) {
  for (double skew : {0., 0.3}) {
    const auto a = banded(100, 5, skew);
    const Net b = right_hand_side(100);
    DirectSolver solver;
    solver.factor(a);
    const Eigen::MatrixXd expected = Eigen::SparseLU<Eigen::SparseMatrix<double>>(a).solve(Eigen::MatrixXd(b));
    EXPECT_LT((solver.solve(b) - expected).norm(), 1e-12);  // round-off
  }
}

TEST(DirectSolver, FactorsAgainWithNewEntriesAndWithANewPattern) {
  DirectSolver solver;
  const Net b = right_hand_side(80);
  for (const auto& a :
       {banded(80, 5, 0), banded(80, 7, 0.1), Eigen::SparseMatrix<double>(banded(80, 6, 0).triangularView<Eigen::Upper>())}) {
    solver.factor(a);
    EXPECT_LT((a * solver.solve(b) - b).norm(), 1e-12);  // round-off
  }
}

TEST(DirectSolver, TachoSolvesSymmetricSystemsAndIsRejectedForOthers) {
  DirectSolver solver(named("Tacho"));
  solver.factor(banded(60, 6, 0));
  const Net b = right_hand_side(60);
  EXPECT_LT((banded(60, 6, 0) * solver.solve(b) - b).norm(), 1e-12);  // round-off
  EXPECT_THROW(solver.factor(banded(60, 6, 0.4)), UserError);
}

TEST(DirectSolver, NamesTheAvailableSolversIfAnUnknownOneIsRequested) {
  try {
    DirectSolver solver(named("Kaiser"));
    FAIL();
  } catch (const UserError& error) {
    EXPECT_NE(std::string(error.what()).find("'Kaiser'"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("KLU2"), std::string::npos);
  }
}

TEST(DirectSolver, StopsAtASingularMatrix) {
  Eigen::SparseMatrix<double> a = banded(30, 5, 0);
  a.col(7) *= 0;
  DirectSolver solver;
  EXPECT_THROW(solver.factor(a), RunFailure);
}

TEST(DirectSolver, RejectsParametersThatAmesos2DoesNotKnow) {
  DirectSolverOptions options;
  options.amesos2 = std::make_shared<Teuchos::ParameterList>();
  options.amesos2->sublist("KLU2").set("Transposee", true);
  DirectSolver solver(options);
  EXPECT_THROW(solver.factor(banded(30, 5, 0)), UserError);
}

}  // namespace
}  // namespace tanktread::membrane
