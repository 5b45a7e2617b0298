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
#include "deck/foreign.hpp"
#include "spline/sparse_systems.hpp"

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

}  // namespace

struct DirectSolver::Impl {
  DirectSolverOptions options;
  RowMajor a;
  Teuchos::RCP<const Map> map;
  Teuchos::RCP<Amesos2::Solver<Matrix, MultiVector>> solver;
  Eigen::MatrixXd inverse;                            // of a small matrix, else empty
  std::optional<spline::IncompleteSolver> iterative;  // in place of the factors

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
      throw UserError("Solvers/Amesos2: Amesos2's " + options.name + " does not take this list: " + last_line(error.what()));
    }
    solver->symbolicFactorization();
    solver->numericFactorization();
    if (a.rows() > worth_inverting) return;
    Eigen::MatrixXd all(a.rows(), a.rows());
    for (Eigen::Index c = 0; c < a.rows(); ++c) all.col(c) = substituted(Eigen::VectorXd::Unit(a.rows(), c));
    inverse = std::move(all);
  }

  /// By the factors.
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
  impl_->a = a;
  impl_->a.makeCompressed();
  impl_->inverse.resize(0, 0);
  if (impl_->iterates()) {
    if (impl_->iterative.emplace().factor(impl_->a) && impl_->residual(*this) < residual_of_iteration) return;
  }
  impl_->iterative.reset();  // complete factors serve any matrix
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

void DirectSolver::solve(const Columns& b, Columns& x) const {
  Eigen::MatrixXd all = b;  // by columns
  if (impl_->iterative)
    for (auto column : all.colwise()) column = impl_->iterative->solve(column);
  else if (impl_->inverse.size() > 0)  // a product with several columns at once would copy the inverse first
    for (auto column : all.colwise()) column = Eigen::VectorXd(impl_->inverse * column);
  else
    all = impl_->substituted(all);
  x = all;
}

Net DirectSolver::solve(const Net& b) const {
  Columns x = b;
  solve(x, x);
  return x;
}

}  // namespace tanktread::membrane
