#pragma once
// Eigenvalues of non-symmetric real matrices: all eigenvalues of a dense matrix by LAPACK, or a few of a matrix-free operator by Anasazi.

#include <complex>
#include <vector>

#include <Eigen/Core>

#include "system/solvers/krylov.hpp"

namespace tanktread::coupling {

/// Eigenvalue and eigenvector: A v = value v, |v| = 1.
struct Eigenpair {
  std::complex<double> value;
  Eigen::VectorXcd vector;
};

/// Returns all eigenpairs of A, in no order. Throws RunFailure if LAPACK fails.
std::vector<Eigenpair> eigenpairs(Eigen::MatrixXd a);

/// Returns the `number` eigenpairs largest in magnitude of a linear map on n unknowns, by block Krylov-Schur, until the residual |A v - value v| is
/// below `tolerance` times the value. `block`: block size; eigenvalues up to this multiplicity are found reliably. Collective. Throws RunFailure if
/// the iteration does not converge.
std::vector<Eigenpair> largest_eigenpairs(const Apply& a, Eigen::Index n, int number, int block, double tolerance);

}  // namespace tanktread::coupling
