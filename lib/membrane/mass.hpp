#pragma once
// Mass matrix of a surface configuration.

#include <vector>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "membrane/packed.hpp"
#include "spline/space.hpp"

namespace tanktread::membrane {

/// Mass matrix S_AB = int N_A N_B dGamma, shape (N, N), symmetric positive definite, units of area. On the current surface it is the left-hand side
/// of (3.6); on the unstressed surface it is M0 in (3.7). The sparsity pattern is built at the first update, the entries are computed at every
/// update.
class MassMatrix {
 public:
  /// `order`: number of Gauss points per direction on elements up to degree 3, and one more for each degree above 3. `space` must outlive this
  /// object.
  explicit MassMatrix(const spline::Space& space, int order = 4);

  /// Returns the matrix of the surface x, valid until the next update. If x equals the x of the latest update, nothing is computed.
  const Eigen::SparseMatrix<double>& update(const Net& x);

  /// Returns the row sums, int N_A dGamma on the surface x, without forming the matrix.
  Eigen::VectorXd row_sums(const Net& x) const;

  /// Releases the memory of the matrix. The next update builds it again.
  void release();

 private:
  const spline::Space* space_;
  std::vector<Group> groups_;
  // Values of the basis functions A at the Gauss points q of a batch of elements, entry [A n_gauss + q], one array per group of batches. Batches with
  // equal extraction matrices share the values.
  std::vector<std::vector<Pack>> values_;
  // Positions in matrix_ of the entries (A, B) and (B, A), for each pair B <= A of basis functions of a batch; one array per group. A batch holds one
  // element per SIMD lane, and a group holds batches of equal degree (packed.hpp). The pairs of all batches of a group are numbered consecutively.
  // The positions for pair k are stored at indices 2 k n + lane for (A, B) and (2 k + 1) n + lane for (B, A), with n = pack_lanes().
  std::vector<std::vector<int>> slots_;
  Eigen::SparseMatrix<double> matrix_;
  Net updated_;  // x of the latest update
};

}  // namespace tanktread::membrane
