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

/// Returns all eigenpairs of the matrix A, in no particular order. Throws RunFailure if LAPACK fails.
std::vector<Eigenpair> eigenpairs(Eigen::MatrixXd a);

/// Returns the number of vectors that largest_eigenpairs() keeps.
Eigen::Index krylov_vectors(int number, int block);

/// Returns the `number` eigenpairs of largest |value| of the linear map A on n unknowns. Block Krylov-Schur iterates until the residuals |A v - value
/// v| are below `tolerance` |value|. `block`: block size; eigenvalues up to this multiplicity are found reliably. Collective. Throws RunFailure if
/// the iteration does not converge. n must exceed krylov_vectors(number, block).
std::vector<Eigenpair> largest_eigenpairs(const Apply& a, Eigen::Index n, int number, int block, double tolerance);

}  // namespace tanktread::coupling
