#pragma once

#include <Eigen/SparseCore>

#include "spline/space.hpp"

namespace tanktread::coupling {

/// R_iA = N_A(xi_i) at the collocation sites, shape (N, N): from control values to values at the sites (4.2).
Eigen::SparseMatrix<double> collocation_matrix(const spline::Space& space);

}  // namespace tanktread::coupling
