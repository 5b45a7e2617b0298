#pragma once
// Sparse linear systems on a symmetric surface, reduced to its fundamental domain.

#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "membrane/direct_solver.hpp"
#include "surface/symmetry.hpp"

namespace tanktread::membrane {

/// Solves A x = b for symmetric fields with a matrix A of a symmetric space that acts on each component alike (a mass matrix or the collocation
/// matrix), A_{ga,gb} = A_ab for every image g. Component c of a symmetric field is determined by its values x_bc at the fundamental points b. For
/// each fundamental point a, they satisfy
///
///   sum_b A^c_ab x_bc = m_a b_ac,   A^c_ab = m_a sum over images gb of b of s_c(g) A_{a,gb}                                  (4.12)
///
/// Here b_ac is the right-hand side, m_a is the number of points in the orbit of a, and s_c(g) is the sign by which the image g multiplies component
/// c. With the factor m_a, A^c is symmetric if A is. If an image maps a point onto itself and s_c = -1, component c is zero at this point, and the
/// system has no unknown for it. Components with equal signs have the same matrix, which is factored once. Without symmetry this is DirectSolver.
class SymmetricSolver {
 public:
  /// Throws as DirectSolver does.
  explicit SymmetricSolver(const DirectSolverOptions& options = {}, surface::Symmetry symmetry = surface::Symmetry());

  /// Factors A, shape (N, N). Throws as DirectSolver does.
  void factor(const Eigen::SparseMatrix<double>& a);

  /// Returns the components 0, 1, 2 of a vector field, ordered such that components with the same LU factors are adjacent. Solving for several
  /// components with one factorisation takes little more time than for one component.
  std::vector<int> components() const;

  /// Returns the symmetric field x, shape (N, 3), with A x = b. Uses only the rows of b at the fundamental points.
  Net solve(const Net& b) const;

  /// Solves only for the given components of the field x; all other components of x are zero.
  Net solve(const Net& b, std::span<const int> components) const;

 private:
  /// Components whose systems have the same matrix.
  struct Part {
    std::vector<int> components, points;  // components: components of the vector field that share LU factors. points: points of the fundamental
                                          // domain (one per symmetry orbit) at which these components may be nonzero
    std::vector<int> unknown;             // for each point of the surface: index of the unknown of its fundamental point; -1 if it has none
    Eigen::VectorXd images;               // m_a, number of points in the orbit of each fundamental point
    DirectSolver solver;
  };
  Part part(const DirectSolverOptions& options, int component) const;

  surface::Symmetry symmetry_;
  std::vector<Part> parts_;  // empty without symmetry
  DirectSolver whole_;
};

}  // namespace tanktread::membrane
