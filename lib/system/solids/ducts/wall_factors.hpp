#pragma once
// LU factors of the operator of a wall that reflections map onto itself.

#include <vector>

#include "base/dense_factors.hpp"
#include "base/types.hpp"
#include "surface/symmetry.hpp"
#include "surface/walls/tube_wall.hpp"
#include "system/parallel/ranks.hpp"

namespace tanktread::coupling {

/// Returns the group of reflections of the axes that map a wall onto itself, as permutations of its collocation points `sites`. On a periodic
/// wall, the image of a point may be a whole period away. A reflection is accepted if it moves collocation points to collocation points, midpoints
/// of elements to midpoints, and the control points of an open wall to control points, up to 1e-10 tube radii.
surface::Symmetry reflections(const surface::TubeWall& wall, const Net& sites);

/// LU factors of an operator A on a wall. A commutes with the reflections of the wall: it maps fields of one parity (surface::Parity) to fields of
/// the same parity. For the fields of one parity c, A is a matrix A^c for the components at fundamental points that the parity does not make zero:
///
///   A^c = (rows of A at fundamental points) E_c,   A^-1 = sum_c E_c (A^c)^-1 D^-1 E_c^T                                            (4.37)
///
/// Here E_c completes a field of parity c from its components at fundamental points, and D is the diagonal matrix of the numbers of points in the
/// orbits of these points. With g reflections, the identity included, there are g matrices with about 1/g of the rows: factoring takes 1/g^2 of the
/// operations, and the factors take 1/g of the memory.
///
/// If all fields have a symmetry, only the parities that this symmetry allows are needed.
class WallFactors {
 public:
  WallFactors() = default;

  /// Sets all matrices to zero. `wall`: reflections of the wall. `fields`: symmetry that all fields have, a subgroup.
  WallFactors(surface::Symmetry wall, const surface::Symmetry& fields);

  /// Returns the points whose rows of A determine A.
  const std::vector<int>& fundamental() const { return wall_.fundamental(); }

  /// Adds a 3 x 3 block of A, in the row of the fundamental point `site` and the column of any point `from`.
  void add(int site, int from, const Mat3& block);

  /// Adds the outer product of two fields that have all reflections as symmetries, a (b.f).
  void add_product(const Net& a, const Net& b);

  /// Sums the matrices over all ranks and factors them. Collective.
  void factor(const Ranks& ranks);

  Net solve(const Net& rhs) const;                 ///< returns A^-1 rhs
  Net solve_transposed(const Net& weights) const;  ///< returns A^-T `weights`

  /// Returns the bytes that the factors would take on each rank.
  static double bytes(const surface::Symmetry& wall, const surface::Symmetry& fields);

 private:
  struct Block {
    surface::Parity parity;
    std::vector<int> unknown;  // row of A^c for component c of the fundamental point a, at the index 3 a + c; -1 if the parity makes it zero
    Eigen::VectorXd orbit;     // diagonal of D
    Eigen::MatrixXd matrix;    // A^c until it is factored
    DenseFactors factors;
  };
  Eigen::VectorXd folded(const Block& block, const Net& field) const;
  void spread(const Block& block, const Eigen::VectorXd& x, Net& field) const;

  surface::Symmetry wall_;
  std::vector<Block> blocks_;
};

}  // namespace tanktread::coupling
