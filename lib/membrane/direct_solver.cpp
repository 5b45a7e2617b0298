#include "membrane/direct_solver.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include <Amesos2.hpp>
#include <Kokkos_Core.hpp>
#include <Teuchos_DefaultSerialComm.hpp>
#include <Teuchos_ParameterList.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Map.hpp>
#include <Tpetra_MultiVector.hpp>

#include "base/errors.hpp"
#include "base/threads.hpp"
#include "deck/value.hpp"
#include "spline/sparse_systems.hpp"

namespace tanktread::membrane {
namespace {

using Map = Tpetra::Map<>;
using Matrix = Tpetra::CrsMatrix<>;
using MultiVector = Tpetra::MultiVector<>;
using RowMajor = Eigen::SparseMatrix<double, Eigen::RowMajor>;

constexpr double residual_allowed = 1e-8, residual_of_iteration = 1e-12;

// Largest number of rows for which the explicit inverse is stored. A solve is then a product with the inverse, which costs less than the overhead of
// an Amesos2 solve (maps, import of several columns). The limit was chosen from solve times of the mass and collocation matrices of spheres.
constexpr Eigen::Index worth_inverting = 256;

// Number of rows from which an iterative solver is as fast as substitution with LU factors, and its setup takes only a small part of the time of the
// LU factorization. The limit was chosen from solve times of the mass and collocation matrices of spheres.
constexpr Eigen::Index worth_iterating = 5000;

/// Returns the first row of each diagonal block of a block-diagonal matrix, followed by the number of rows.
std::vector<Eigen::Index> block_starts(const RowMajor& a) {
  const Eigen::Index n = a.rows();
  const int *row = a.outerIndexPtr(), *column = a.innerIndexPtr();
  std::vector<Eigen::Index> starts{0}, least(static_cast<std::size_t>(n) + 1, n);  // entry i: smallest column index of the nonzeros in rows i, i + 1,
                                                                                   // ..., n - 1
  for (Eigen::Index i = n; i-- > 0;) {
    if (row[i] == row[i + 1]) return {0, n};
    least[static_cast<std::size_t>(i)] = std::min<Eigen::Index>(least[static_cast<std::size_t>(i) + 1], column[row[i]]);
  }
  Eigen::Index most = 0;  // largest column index of a nonzero in all rows so far
  for (Eigen::Index i = 0; i < n; ++i) {
    most = std::max<Eigen::Index>(most, column[row[i + 1] - 1]);
    if (most <= i && least[static_cast<std::size_t>(i) + 1] > i) starts.push_back(i + 1);
  }
  return starts;
}

/// Returns whether two diagonal blocks of `size` rows are equal up to round-off. (Blocks of equal particles at different positions differ by
/// round-off.)
bool equal_blocks(const RowMajor& a, Eigen::Index one, Eigen::Index other, Eigen::Index size) {
  const int* row = a.outerIndexPtr();
  const int first = row[one], apart = row[other] - first, entries = row[one + size] - first;
  if (row[other + size] - row[other] != entries) return false;
  for (Eigen::Index i = 0; i < size; ++i)
    if (row[other + i] - row[one + i] != apart) return false;
  const Eigen::Map<const Eigen::ArrayXi> columns(a.innerIndexPtr() + first, entries), others(a.innerIndexPtr() + first + apart, entries);
  const Eigen::Map<const Eigen::ArrayXd> values(a.valuePtr() + first, entries), of_other(a.valuePtr() + first + apart, entries);
  return (others - columns == static_cast<int>(other - one)).all() && (of_other - values).abs().maxCoeff() <= 1e-13 * values.abs().maxCoeff();
}

std::string solvers_of_this_build() {
  std::string names;
  for (const char* name : {"KLU2", "Tacho", "Basker", "ShyLUBasker", "SuperLU", "SuperLU_MT", "SuperLU_DIST", "MUMPS", "UMFPACK", "Cholmod",
                           "PARDISO_MKL", "LAPACK", "STRUMPACK"})
    if (Amesos2::query(name)) names += (names.empty() ? "" : ", ") + std::string(name);
  return names;
}

// Initialises Kokkos, which Tpetra needs, if the program has not done so (serial tests).
void start_kokkos() {
  if (!Kokkos::is_initialized()) Kokkos::initialize();
}

std::string last_line(const std::string& text) {
  const auto end = text.find_last_not_of(" \n");
  if (end == std::string::npos) return text;
  const auto before = text.find_last_of('\n', end);
  return text.substr(before == std::string::npos ? 0 : before + 1, end - (before == std::string::npos ? 0 : before + 1) + 1);
}

}  // namespace

struct DirectSolver::Impl {
  DirectSolverOptions options;
  RowMajor a;
  Teuchos::RCP<const Map> map;
  Teuchos::RCP<Amesos2::Solver<Matrix, MultiVector>> solver;
  Eigen::MatrixXd inverse;                            // inverse of a small matrix, otherwise empty
  std::optional<spline::IncompleteSolver> iterative;  // iterative solver with incomplete LU factors, used instead of `solver`

  /// Equal diagonal blocks: the first row of each block, the number of rows per block, and one solver for all of them.
  struct Kind {
    std::vector<Eigen::Index> starts;
    Eigen::Index size;
    DirectSolver solver;
  };
  std::vector<Kind> kinds;  // solvers of equal diagonal blocks; if not empty, used instead of `inverse`, `iterative` and `solver`

  /// Factors one diagonal block of each kind and returns true, if at least half of the blocks are equal to earlier blocks. Otherwise does nothing and
  /// returns false.
  bool factor_equal_blocks() {
    kinds.clear();
    const std::vector<Eigen::Index> starts = block_starts(a);
    const std::size_t n_blocks = starts.size() - 1;
    if (n_blocks < 2) return false;
    for (std::size_t k = 0; k < n_blocks && 2 * kinds.size() <= n_blocks; ++k) {
      const Eigen::Index size = starts[k + 1] - starts[k];
      const auto known = std::ranges::find_if(
          kinds, [&](const Kind& kind) { return kind.size == size && equal_blocks(a, kind.starts.front(), starts[k], size); });
      if (known == kinds.end())
        kinds.push_back({{starts[k]}, size, DirectSolver(options)});
      else
        known->starts.push_back(starts[k]);
    }
    if (2 * kinds.size() > n_blocks) kinds.clear();
    for (Kind& kind : kinds) kind.solver.factor(a.block(kind.starts.front(), kind.starts.front(), kind.size, kind.size));
    if (!kinds.empty()) RowMajor().swap(a);  // a swap frees the memory of the matrix, whereas an assignment would keep it
    return !kinds.empty();
  }

  /// Returns A^-1 times the columns.
  Eigen::MatrixXd solved(Eigen::MatrixXd all) const {
    if (iterative) {
      each_item(all.cols(), [&](Eigen::Index c) { all.col(c) = iterative->solve(all.col(c)); });
    } else if (inverse.size() == 0) {
      all = substituted(all);
    } else if (all.cols() <= 3) {  // column by column, because Eigen's product with few columns would copy the inverse first
      for (auto column : all.colwise()) column = Eigen::VectorXd(inverse * column);
    } else {
      all = inverse * all;
    }
    return all;
  }

  /// Replaces x by A^-1 x, block by block.
  void solve_blocks(RightHandSides& x) const {
    for (const Kind& kind : kinds) {
      Eigen::MatrixXd all(kind.size, x.cols() * static_cast<Eigen::Index>(kind.starts.size()));
      const auto each = [&](const auto& use) {
        for (std::size_t k = 0; k < kind.starts.size(); ++k)
          use(all.middleCols(x.cols() * static_cast<Eigen::Index>(k), x.cols()), x.middleRows(kind.starts[k], kind.size));
      };
      each([](auto columns, auto rows) { columns = rows; });
      all = kind.solver.impl_->solved(std::move(all));
      each([](auto columns, auto rows) { rows = columns; });
    }
  }

  bool iterates() const {
    return options.sparse_systems == "iterative" || (options.sparse_systems == "auto" && a.rows() >= worth_iterating);
  }

  void factor() {
    const auto n = static_cast<std::size_t>(a.rows());
    map = Teuchos::rcp(new Map(n, n, 0, Teuchos::rcp(new Teuchos::SerialComm<int>)));
    Teuchos::ArrayRCP<std::size_t> starts(n + 1);
    Teuchos::ArrayRCP<int> columns(a.nonZeros());
    Teuchos::ArrayRCP<double> values(a.nonZeros());
    std::copy_n(a.outerIndexPtr(), n + 1, starts.begin());
    std::copy_n(a.innerIndexPtr(), a.nonZeros(), columns.begin());
    std::copy_n(a.valuePtr(), a.nonZeros(), values.begin());
    const auto matrix = Teuchos::rcp(new Matrix(map, map, starts, columns, values));
    matrix->fillComplete(map, map);
    const auto vectors = [&] { return Teuchos::rcp(new MultiVector(map, 3)); };
    solver = Amesos2::create<Matrix, MultiVector>(options.name, matrix, vectors(), vectors());
    const auto list = Teuchos::rcp(options.amesos2 ? new Teuchos::ParameterList(*options.amesos2) : new Teuchos::ParameterList);
    list->setName("Amesos2");
    deck::check_foreign("Solvers/Amesos2", *list, *solver->getValidParameters());
    try {
      solver->setParameters(list);
    } catch (const std::exception& error) {
      throw UserError("Solvers/Amesos2: Amesos2's " + options.name + " does not accept these parameters: " + last_line(error.what()));
    }
    solver->symbolicFactorization();
    solver->numericFactorization();
    if (a.rows() > worth_inverting) return;
    Eigen::MatrixXd all(a.rows(), a.rows());
    for (Eigen::Index c = 0; c < a.rows(); ++c) all.col(c) = substituted(Eigen::VectorXd::Unit(a.rows(), c));
    inverse = std::move(all);
  }

  /// Solves with the LU factors of Amesos2.
  Eigen::MatrixXd substituted(const Eigen::MatrixXd& right) const {
    MultiVector known(map, right.cols()), found(map, right.cols());
    for (Eigen::Index c = 0; c < right.cols(); ++c)
      Eigen::Map<Eigen::VectorXd>(known.getDataNonConst(c).getRawPtr(), right.rows()) = right.col(c);
    solver->solve(Teuchos::ptr(&found), Teuchos::ptr(&known));
    Eigen::MatrixXd left(right.rows(), right.cols());
    for (Eigen::Index c = 0; c < right.cols(); ++c)
      left.col(c) = Eigen::Map<const Eigen::VectorXd>(found.getData(c).getRawPtr(), right.rows());
    return left;
  }

  // Solves a system whose exact solution is known and has no small or repeated entries. Returns the relative residual.
  double residual(const DirectSolver& self) const {
    Net known(a.rows(), 3);
    for (int i = 0; i < known.size(); ++i) known.data()[i] = 1 + 0.5 * std::sin(1.7 * i);
    const Net right = a * known;
    const Net found = self.solve(right);
    return (a * found - right).norm() / right.norm();
  }
};

DirectSolver::DirectSolver(const DirectSolverOptions& options) : impl_(std::make_unique<Impl>()) {
  start_kokkos();
  impl_->options = options;
  if (!Amesos2::query(options.name))
    throw UserError("Solvers/direct solver: this build's Amesos2 has no solver '" + options.name + "'; it has " + solvers_of_this_build() +
                    ".");
}
DirectSolver::~DirectSolver() = default;
DirectSolver::DirectSolver(DirectSolver&&) noexcept = default;
DirectSolver& DirectSolver::operator=(DirectSolver&&) noexcept = default;

void DirectSolver::factor(const Eigen::SparseMatrix<double>& a) {
  impl_->a = a;
  impl_->a.makeCompressed();
  impl_->inverse.resize(0, 0);
  if (impl_->factor_equal_blocks()) return;
  if (impl_->iterates()) {
    if (impl_->iterative.emplace().factor(impl_->a) && impl_->residual(*this) < residual_of_iteration) return;
  }
  impl_->iterative.reset();  // complete LU factors, which work for any regular matrix, replace the iterative solver
  std::string trouble;
  try {
    impl_->factor();
    const double left = impl_->residual(*this);
    if (left < residual_allowed) return;
    trouble = "it leaves a relative residual of " + std::to_string(left);
  } catch (const UserError&) {
    throw;
  } catch (const std::exception& error) {
    trouble = last_line(error.what());
  }
  if (impl_->options.name != "KLU2")
    throw UserError("Solvers/direct solver: " + impl_->options.name + " does not suit a sparse system of this run (" + trouble +
                    "); KLU2 does.");
  throw RunFailure("A sparse system of " + std::to_string(a.rows()) + " unknowns could not be factored by KLU2: " + trouble + ".");
}

void DirectSolver::solve(const RightHandSides& b, RightHandSides& x) const {
  if (impl_->kinds.empty()) {
    x = impl_->solved(b);
  } else {
    x = b;
    impl_->solve_blocks(x);
  }
}

Net DirectSolver::solve(const Net& b) const {
  RightHandSides x = b;
  solve(x, x);
  return x;
}

}  // namespace tanktread::membrane
