#pragma once
// Eigenvalues of real matrices that are not symmetric: all of one that is there, by LAPACK, or a few of one that is a function, by Anasazi.

#include <complex>
#include <vector>

#include <Eigen/Core>

#include "system/solvers/krylov.hpp"

namespace tanktread::coupling {

/// A v = value v, |v| = 1.
struct Eigenpair {
  std::complex<double> value;
  Eigen::VectorXcd vector;
};

/// All of A, in no order. Throws RunFailure where LAPACK does not find them.
std::vector<Eigenpair> eigenpairs(Eigen::MatrixXd a);

/// Those `number` of the linear map of n numbers whose values are largest in size, by block Krylov-Schur, until the residual |A v - value v| is below
/// `tolerance` times the value; `block` is the multiplicity that is sure to be seen. Collective. Throws RunFailure where they are not found.
std::vector<Eigenpair> largest_eigenpairs(const Apply& a, Eigen::Index n, int number, int block, double tolerance);

}  // namespace tanktread::coupling
