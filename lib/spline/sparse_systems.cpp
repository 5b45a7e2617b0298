#include "spline/sparse_systems.hpp"

#include <algorithm>

namespace tanktread::spline {

namespace {

// Parameters of ILUT, measured with the mass matrices of spheres with 3,458 and 13,826 control points. If entries below 1e-2 of the norm of their
// row are dropped, the solver takes 7 iterations; below 1e-4, it takes 3 iterations and less time. Factors with more than twice the entries of the
// matrix bring no gain.
constexpr double dropped = 1e-4;
constexpr int fill = 2;

}  // namespace

/// Assembles the matrix column by column: for each unknown, adds up the columns of this unknown in all element matrices, in a dense vector.
Eigen::SparseMatrix<double> assemble(int n, const std::vector<LocalMatrix>& local) {
  struct Entry {
    std::size_t element;
    Eigen::Index row;
  };
  std::vector<std::vector<Entry>> around(n);
  for (std::size_t k = 0; k < local.size(); ++k)
    for (std::size_t i = 0; i < local[k].unknowns.size(); ++i) around[local[k].unknowns[i]].push_back({k, Eigen::Index(i)});

  Eigen::SparseMatrix<double> out(n, n);
  out.reserve(Eigen::Index(50) * n);
  std::vector<double> sum(n, 0.0);
  std::vector<int> rows, last(n, -1);  // last[i]: latest column in which row i has an entry
  for (int j = 0; j < n; ++j) {
    rows.clear();
    for (const auto& [element, row] : around[j]) {
      const auto& [unknowns, values, factor] = local[element];
      const double* column = values->col(row).data();
      for (std::size_t i = 0; i < unknowns.size(); ++i) {
        const int r = unknowns[i];
        if (last[r] != j) rows.push_back(r), sum[r] = 0;
        last[r] = j;
        sum[r] += factor * column[i];
      }
    }
    std::sort(rows.begin(), rows.end());
    out.startVec(j);
    for (int r : rows) out.insertBack(r, j) = sum[r];
  }
  out.finalize();
  return out;
}

IncompleteSolver::IncompleteSolver() {
  factors_.setDroptol(dropped);
  factors_.setFillfactor(fill);
}

bool IncompleteSolver::factor(const Eigen::SparseMatrix<double, Eigen::RowMajor>& a) {
  a_ = &a;
  return factors_.compute(a).info() == Eigen::Success;
}

Eigen::VectorXd IncompleteSolver::solve(const Eigen::VectorXd& b) const { return solve(b, Eigen::VectorXd::Zero(b.size())); }

/// Calls the function of Eigen's BiCGSTAB, which itself stores the number of iterations and cannot be used by several threads.
Eigen::VectorXd IncompleteSolver::solve(const Eigen::VectorXd& b, const Eigen::VectorXd& start) const {
  Eigen::VectorXd x = start;
  Eigen::Index iterations = 30;
  double error = 1e-14;
  Eigen::internal::bicgstab(*a_, b, x, factors_, iterations, error);
  return x;
}

}  // namespace tanktread::spline
