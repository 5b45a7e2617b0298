#pragma once
// Sparse linear systems of a symmetric surface, solved on its fundamental part.

#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "membrane/direct_solver.hpp"
#include "surface/symmetry.hpp"

namespace tanktread::membrane {

/// Solves A x = b for symmetric fields with a scalar matrix A of a symmetric space (a mass matrix, the collocation matrix), A_{ga,gb} = A_ab for
/// every image g. Component c of such a field is told by the fundamental points a, b, and those obey
///
///   sum_b A^c_ab x_bc = m_a b_ac,   A^c_ab = m_a sum over images gb of b of s_c(g) A_{a,gb}                                  (4.12)
///
/// with m_a the number of images of a, which keeps a symmetric matrix symmetric, and s_c(g) the sign that g gives to the component. A point that an
/// image leaves in place and turns c around at drops out, for c vanishes there. Components of equal signs share a factor. Without symmetry this is
/// DirectSolver.
class SymmetricSolver {
 public:
  /// Throws as DirectSolver does.
  explicit SymmetricSolver(const DirectSolverOptions& options = {}, surface::Symmetry symmetry = surface::Symmetry());

  /// Factors A, shape (N, N). Throws as DirectSolver does.
  void factor(const Eigen::SparseMatrix<double>& a);

  /// The components in an order in which those that share a factor, and are solved for together in little more time than one, are neighbours.
  std::vector<int> components() const;

  /// The symmetric x with A x = b, shape (N, 3), from the fundamental rows of b.
  Net solve(const Net& b) const;

  /// The same for some components only; the others are zero.
  Net solve(const Net& b, std::span<const int> components) const;

 private:
  /// Components that share a factor.
  struct Part {
    std::vector<int> components, points;  // fundamental points where these components need not vanish
    std::vector<int> unknown;             // of each point of the surface: that of its fundamental point, or -1
    Eigen::VectorXd images;               // m
    DirectSolver solver;
  };
  Part part(const DirectSolverOptions& options, int component) const;

  surface::Symmetry symmetry_;
  std::vector<Part> parts_;  // empty without symmetry
  DirectSolver whole_;
};

}  // namespace tanktread::membrane
