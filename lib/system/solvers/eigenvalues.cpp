#include "system/solvers/eigenvalues.hpp"

#include <algorithm>

#include <AnasaziBasicEigenproblem.hpp>
#include <AnasaziBlockKrylovSchurSolMgr.hpp>
#include <AnasaziTpetraAdapter.hpp>
#include <Teuchos_LAPACK.hpp>
#include <Teuchos_ParameterList.hpp>

#include "base/errors.hpp"
#include "system/solvers/vectors.hpp"

namespace tanktread::coupling {

namespace {

const RunFailure not_found("the computation of the eigenvalues of the linearised motion failed");

/// Returns eigenpairs from eigenvalues and from eigenvectors in LAPACK's format. For each conjugate pair, `columns` contains one complex eigenvector:
/// its real part, and in the next column its imaginary part.
std::vector<Eigenpair> unpacked(const Eigen::VectorXcd& values, const Eigen::MatrixXd& columns) {
  std::vector<Eigenpair> pairs;
  bool second = false;  // whether the value belongs to the same pair as the value before; a repeated pair follows the first one
  for (Eigen::Index k = 0; k < values.size(); ++k) {
    const bool oscillates = values[k].imag() != 0;
    if (second) {
      second = false;
      pairs.push_back({values[k], pairs.back().vector.conjugate()});
      continue;
    }
    Eigen::VectorXcd vector = columns.col(k).cast<std::complex<double>>();
    if (oscillates && k + 1 < columns.cols()) vector += std::complex<double>(0, 1) * columns.col(k + 1);
    pairs.push_back({values[k], vector.normalized()});
    second = oscillates;
  }
  return pairs;
}

/// Returns the number of blocks of vectors of the block Krylov-Schur iteration, without the block of its residual.
int blocks(int number, int block) { return 2 * number / block + 10; }

}  // namespace

Eigen::Index krylov_vectors(int number, int block) { return static_cast<Eigen::Index>(blocks(number, block) + 1) * block; }

std::vector<Eigenpair> eigenpairs(Eigen::MatrixXd a) {
  const int n = static_cast<int>(a.rows());
  Eigen::VectorXd real(n), imaginary(n);
  Eigen::MatrixXd columns(n, n);
  const Teuchos::LAPACK<int, double> lapack;
  double size = 0;
  int info = 0;
  const auto run = [&](double* work, int length) {
    lapack.GEEV('N', 'V', n, a.data(), n, real.data(), imaginary.data(), nullptr, 1, columns.data(), n, work, length, nullptr, &info);
  };
  run(&size, -1);
  std::vector<double> work(static_cast<std::size_t>(size));
  if (a.allFinite()) run(work.data(), static_cast<int>(work.size()));
  if (info != 0 || !a.allFinite()) throw not_found;
  return unpacked(real.cast<std::complex<double>>() + std::complex<double>(0, 1) * imaginary, columns);
}

std::vector<Eigenpair> largest_eigenpairs(const Apply& a, Eigen::Index n, int number, int block, double tolerance) {
  const auto map = replicated(n);
  Eigen::VectorXd start(n * block);
  for (Eigen::Index i = 0; i < start.size(); ++i) start[i] = std::sin(1.0 + static_cast<double>(i * i % 7919));  // pseudo-random, equal on every run
  const auto first = Teuchos::rcp(new Vectors(map, static_cast<std::size_t>(block)));
  for (int k = 0; k < block; ++k) set_column(*first, static_cast<std::size_t>(k), start.segment(k * n, n));
  const auto problem =
      Teuchos::rcp(new Anasazi::BasicEigenproblem<double, Vectors, Operator>(Teuchos::rcp(new FunctionOperator(map, a)), first));
  problem->setHermitian(false);
  problem->setNEV(number);
  if (!problem->setProblem()) throw not_found;
  Teuchos::ParameterList list;
  list.set("Which", "LM").set("Block Size", block).set("Num Blocks", blocks(number, block));
  list.set("Maximum Restarts", 50).set("Convergence Tolerance", tolerance).set("Verbosity", static_cast<int>(Anasazi::Errors));
  Anasazi::BlockKrylovSchurSolMgr<double, Vectors, Operator> manager(problem, list);
  if (manager.solve() != Anasazi::Converged) throw not_found;
  const auto& solution = problem->getSolution();
  Eigen::VectorXcd values(solution.numVecs);
  Eigen::MatrixXd columns(n, static_cast<Eigen::Index>(solution.Evecs->getNumVectors()));
  for (int k = 0; k < solution.numVecs; ++k) values[k] = {solution.Evals[k].realpart, solution.Evals[k].imagpart};
  for (Eigen::Index k = 0; k < columns.cols(); ++k) columns.col(k) = column(*solution.Evecs, static_cast<std::size_t>(k));
  return unpacked(values, columns);
}

}  // namespace tanktread::coupling
