#pragma once
// Inverse of the single layer of plates with equal elements, by Fourier series.

#include <array>
#include <vector>

#include "base/types.hpp"

namespace tanktread::coupling {

/// Operator from force densities f to velocities u on plates that have the same grid of n1 x n2 equal elements over one period. Its 3 x 3 blocks g
/// depend only on the difference of the grid indices c and s of two points (block circulant). A discrete Fourier transform (^) therefore reduces it,
/// for each pair k of wave numbers, to a matrix M(k) with three rows and columns per plate:
///
///   u_s = sum_c g(c - s) f_c,   M(k) = sum_d g(d) exp(i k.d),   u^(k) = M(k) f^(k)                                         (2.50)
///
/// Only the rows of one collocation point per plate are assembled.
class PlateFactors {
 public:
  /// `rows`: rows of the operator for one collocation point per plate, three rows per plate and 3 N columns for the N points of all plates. `point`:
  /// grid indices of these collocation points; point i n2 + j of a plate has the indices i, j. `regular`: matrix that is added to M(0) of (2.50),
  /// the operator on uniform densities, so that its inverse exists.
  PlateFactors(const Eigen::MatrixXd& rows, const std::array<int, 2>& grid, const std::array<int, 2>& point, const Eigen::MatrixXd& regular);

  /// Returns the part of f with wave numbers k != 0 for the velocities u. Sets row p of `uniform` to the mean velocity of plate p. From these
  /// velocities the caller must compute the part of f with k = 0, and add it.
  Net solve(const Net& u, Net& uniform) const;

  /// Returns M(0) + `regular`.
  const Eigen::MatrixXd& uniform() const { return uniform_; }

 private:
  using Complex = Eigen::MatrixXcd;
  Complex transformed(const Net& u) const;

  std::array<int, 2> grid_;
  int plates_;
  std::array<Complex, 2> waves_;  // Fourier matrices of both directions: row k, column s is exp(-2 pi i k s/n)
  std::vector<Complex> inverse_;  // entry k1 n2 + k2: inverse of the matrix M(k) (2.50) for the wave numbers k1, k2
  Eigen::MatrixXd uniform_;
};

}  // namespace tanktread::coupling
