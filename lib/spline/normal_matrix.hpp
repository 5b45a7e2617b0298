#pragma once
// Sparse symmetric matrices that are sums over elements.

#include <vector>

#include <Eigen/SparseCore>

#include "spline/space.hpp"

namespace tanktread::spline {

/// Lower triangle of sum_e R_e^T local[e] R_e, R_e picking the control points of element e. local[e] has shape (m, m); an empty one adds nothing.
Eigen::SparseMatrix<double> assemble(const Space& space, const std::vector<Eigen::MatrixXd>& local);

}  // namespace tanktread::spline
