#include "membrane/direct_solver.hpp"

#include <algorithm>
#include <array>
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
#include "deck/foreign.hpp"
#include "membrane/incomplete_solver.hpp"

namespace tanktread::membrane {
namespace {

using Map = Tpetra::Map<>;
using Matrix = Tpetra::CrsMatrix<>;
using MultiVector = Tpetra::MultiVector<>;
using RowMajor = Eigen::SparseMatrix<double, Eigen::RowMajor>;

constexpr double residual_allowed = 1e-8, residual_of_iteration = 1e-12;

// Rows up to which the inverse is kept, and multiplied by: what Amesos2 does about a solve, maps and an import for several columns, takes
// longer than the product. Measured with the mass and collocation matrices of spheres.
constexpr Eigen::Index worth_inverting = 256;

// Rows from which iteration is as fast as substitution, and set up in a small part of the time. Measured likewise.
constexpr Eigen::Index worth_iterating = 5000;

std::string solvers_of_this_build() {
  std::string names;
  for (const char* name : {"KLU2", "Tacho", "Basker", "ShyLUBasker", "SuperLU", "SuperLU_MT", "SuperLU_DIST", "MUMPS", "UMFPACK", "Cholmod",
                           "PARDISO_MKL", "LAPACK", "STRUMPACK"})
    if (Amesos2::query(name)) names += (names.empty() ? "" : ", ") + std::string(name);
  return names;
}

// Tpetra needs Kokkos; a program that has not started it (a serial test) gets it here.
void start_kokkos() {
  if (!Kokkos::is_initialized()) Kokkos::initialize();
}

std::string last_line(const std::string& text) {
  const auto end = text.find_last_not_of(" \n");
  if (end == std::string::npos) return text;
  const auto before = text.find_last_of('\n', end);
  return text.substr(before == std::string::npos ? 0 : before + 1, end - (before == std::string::npos ? 0 : before + 1) + 1);
}

bool same_pattern(const RowMajor& a, const RowMajor& b) {
  return a.rows() == b.rows() && a.nonZeros() == b.nonZeros() &&
         std::equal(a.outerIndexPtr(), a.outerIndexPtr() + a.rows() + 1, b.outerIndexPtr()) &&
         std::equal(a.innerIndexPtr(), a.innerIndexPtr() + a.nonZeros(), b.innerIndexPtr());
}

}  // namespace

struct DirectSolver::Impl {
  DirectSolverOptions options;
  RowMajor a;
  Teuchos::RCP<const Map> map;
  Teuchos::RCP<Matrix> matrix;
  std::array<Teuchos::RCP<MultiVector>, 3> x, b;  // of one, two and three columns
  Teuchos::RCP<Amesos2::Solver<Matrix, MultiVector>> solver;
  Eigen::MatrixXd inverse;  // of a small matrix, else empty
  std::optional<IncompleteSolver> iterative;  // in place of the factors

  bool iterates() const {
    return options.sparse_systems == "iterative" || (options.sparse_systems == "auto" && a.rows() >= worth_iterating);
  }

  // Everything that depends on the pattern only.
  void analyse() {
    const auto n = static_cast<std::size_t>(a.rows());
    map = Teuchos::rcp(new Map(n, n, 0, Teuchos::rcp(new Teuchos::SerialComm<int>)));
    Teuchos::ArrayRCP<std::size_t> starts(n + 1);
    Teuchos::ArrayRCP<int> columns(a.nonZeros());
    std::copy_n(a.outerIndexPtr(), n + 1, starts.begin());
    std::copy_n(a.innerIndexPtr(), a.nonZeros(), columns.begin());
    const Teuchos::ArrayRCP<double> values(a.nonZeros());
    matrix = Teuchos::rcp(new Matrix(map, map, starts, columns, values));
    refill();
    for (std::size_t k = 0; k < 3; ++k) {
      x[k] = Teuchos::rcp(new MultiVector(map, k + 1));
      b[k] = Teuchos::rcp(new MultiVector(map, k + 1));
    }
    solver = Amesos2::create<Matrix, MultiVector>(options.name, matrix, x[2], b[2]);
    const auto list = Teuchos::rcp(options.amesos2 ? new Teuchos::ParameterList(*options.amesos2) : new Teuchos::ParameterList);
    list->setName("Amesos2");
    deck::check_foreign("Solvers/Amesos2", *list, *solver->getValidParameters());
    try {
      solver->setParameters(list);
    } catch (const std::exception& error) {
      throw UserError("Solvers/Amesos2: Amesos2's " + options.name + " does not take this list: " + last_line(error.what()));
    }
    solver->symbolicFactorization();
  }

  void refill() {
    matrix->resumeFill();
    for (int row = 0; row < a.rows(); ++row) {
      const int first = a.outerIndexPtr()[row], n = a.outerIndexPtr()[row + 1] - first;
      matrix->replaceLocalValues(row, n, a.valuePtr() + first, a.innerIndexPtr() + first);
    }
    matrix->fillComplete(map, map);
  }

  // By the factors.
  void invert() {
    inverse.resize(0, 0);
    const Eigen::Index n = a.rows();
    if (n > worth_inverting) return;
    Eigen::MatrixXd all(n, n);
    Columns unit = Columns::Zero(n, 1), one(n, 1);
    for (Eigen::Index c = 0; c < n; ++c) {
      unit(c, 0) = 1;
      solve(unit, one);
      unit(c, 0) = 0;
      all.col(c) = one;
    }
    inverse = std::move(all);
  }

  // Up to three columns.
  void solve(const Eigen::Ref<const Columns>& right, Eigen::Ref<Columns> left) const {
    const auto columns = static_cast<std::size_t>(right.cols());
    MultiVector &known = *b[columns - 1], &found = *x[columns - 1];
    for (std::size_t c = 0; c < columns; ++c)
      Eigen::Map<Eigen::VectorXd>(known.getDataNonConst(c).getRawPtr(), right.rows()) = right.col(static_cast<Eigen::Index>(c));
    solver->solve(Teuchos::ptr(&found), Teuchos::ptr(&known));
    for (std::size_t c = 0; c < columns; ++c)
      left.col(static_cast<Eigen::Index>(c)) = Eigen::Map<const Eigen::VectorXd>(found.getData(c).getRawPtr(), right.rows());
  }

  // Solves for a net without small or repeated entries and looks at what is left.
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
  RowMajor rows = a;
  rows.makeCompressed();
  const bool known = impl_->solver != Teuchos::null && same_pattern(rows, impl_->a);
  impl_->a = std::move(rows);
  impl_->iterative.reset();
  if (impl_->iterates()) {
    impl_->inverse.resize(0, 0);
    if (impl_->iterative.emplace().factor(impl_->a) && impl_->residual(*this) < residual_of_iteration) return;
    impl_->iterative.reset();  // complete factors serve any matrix
  }
  std::string trouble;
  try {
    if (known)
      impl_->refill();
    else
      impl_->analyse();
    impl_->solver->numericFactorization();
    impl_->invert();
    const double left = impl_->residual(*this);
    if (!(left < residual_allowed)) trouble = "it leaves a relative residual of " + std::to_string(left);
  } catch (const UserError&) {
    throw;
  } catch (const std::exception& error) {
    trouble = last_line(error.what());
  }
  if (trouble.empty()) return;
  impl_->solver = Teuchos::null;
  if (impl_->options.name != "KLU2")
    throw UserError("Solvers/direct solver: " + impl_->options.name + " does not suit a sparse system of this run (" + trouble +
                    "); KLU2 does.");
  throw RunFailure("A sparse system of " + std::to_string(a.rows()) + " unknowns could not be factored by KLU2: " + trouble + ".");
}

void DirectSolver::solve(const Columns& b, Columns& x) const {
  if (impl_->iterative) {
    const Eigen::MatrixXd right = b;  // by columns
    x.resize(b.rows(), b.cols());
    for (Eigen::Index c = 0; c < b.cols(); ++c) x.col(c) = impl_->iterative->solve(right.col(c));
    return;
  }
  if (impl_->inverse.size() > 0) {
    const Eigen::MatrixXd right = b;  // by columns
    x.resize(b.rows(), b.cols());
    for (Eigen::Index c = 0; c < b.cols(); ++c) x.col(c) = impl_->inverse * right.col(c);
    return;
  }
  x.resize(b.rows(), b.cols());
  impl_->solve(b, x);
}

Net DirectSolver::solve(const Net& b) const {
  Columns x = b;
  solve(x, x);
  return x;
}

}  // namespace tanktread::membrane
