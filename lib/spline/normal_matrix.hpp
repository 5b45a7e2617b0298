#pragma once
// Sparse symmetric matrices that are sums over elements.

#include <vector>

#include <Eigen/SparseCore>

namespace tanktread::spline {

/// What one element adds: values(i, j) to the entry of unknowns i and j of its own.
struct LocalMatrix {
  std::vector<int> unknowns;  ///< m of them
  Eigen::MatrixXd values;     ///< shape (m, m), symmetric; an empty one adds nothing
};

/// Lower triangle of the sum, shape (n, n).
Eigen::SparseMatrix<double> assemble(int n, const std::vector<LocalMatrix>& local);

}  // namespace tanktread::spline
