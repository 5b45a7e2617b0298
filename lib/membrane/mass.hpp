#pragma once
// The mass matrix of a configuration.

#include <vector>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "membrane/packed.hpp"
#include "spline/space.hpp"

namespace tanktread::membrane {

/// S_AB = int N_A N_B dGamma, shape (N, N), symmetric positive definite; left-hand side of (3.6) on the current surface and of (3.7),
/// there called M0, on the unstressed one. The pattern is made at the first update, the entries as often as the surface moves. Units area.
class MassMatrix {
 public:
  /// `order` Gauss points per direction at degree 3, one more for each degree beyond. `space` must outlive this.
  explicit MassMatrix(const spline::Space& space, int order = 4);

  /// Returns the matrix of the surface x, valid until the next update. If x is that of the latest update, nothing is computed.
  const Eigen::SparseMatrix<double>& update(const Net& x);

  /// Its row sums, int N_A dGamma of the surface x, without the matrix.
  Eigen::VectorXd row_sums(const Net& x) const;

  /// Gives back the memory of the matrix, which the next update makes again.
  void release();

 private:
  const spline::Space* space_;
  std::vector<Group> groups_;
  std::vector<std::vector<Pack>> values_;  // N_A at Gauss points, a group; of each extraction [A n_gauss + q]
  std::vector<std::vector<int>> slots_;    // of (A, B <= A) and of (B, A) among the entries, a group; [(batch pairs + pair) pack_lanes() + lane]
  Eigen::SparseMatrix<double> matrix_;
  Net updated_;  // x of the latest update
};

}  // namespace tanktread::membrane
