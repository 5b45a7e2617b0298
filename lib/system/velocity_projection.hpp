#pragma once
// Control values of a velocity by least squares, in place of collocation.

#include <vector>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "membrane/symmetric_solver.hpp"
#include "spline/space.hpp"
#include "stokes/sums/self_field.hpp"
#include "surface/symmetry.hpp"
#include "system/ranks.hpp"

namespace tanktread::coupling {

/// The field whose values at places between the collocation sites are nearest to those given,
///
///   v = (sum_q w_q N(q) N(q)^T)^-1 sum_q w_q N(q) u(q),   w_q the share of the unstressed area                            (4.21)
///
/// The cubic spline that fits a smooth u best errs by h^4 B4(t)/24 times its fourth derivative on an element of length h, with the Bernoulli
/// polynomial B4 = t^4 - 2 t^3 + t^2 - 1/30. Collocated at the knots it errs like B4(t) + 1/30, whose mean is not 0: the load of the next shape, the
/// volume and every layer at a distance see it. Places are the zeros of B4, two a direction, where the best fit does not err.
class VelocityProjection {
 public:
  /// Symmetric velocities are asked for in the fundamental part alone.
  VelocityProjection(const spline::Space& space, const Net& unstressed, const surface::Symmetry& symmetry,
                     const membrane::DirectSolverOptions& direct, const Ranks& ranks);

  const stokes::Sites& sites() const { return sites_; }
  const std::vector<int>& own() const { return own_; }                         ///< sites of this rank, ascending; each has one rank
  const Eigen::SparseMatrix<double>& values() const { return values_; }        ///< N_A at the sites, shape (sites, N)
  Net normals(const Net& x) const;                                             ///< unit normals of the surface x at the sites
  Net control_values(const Net& at_sites) const;                               ///< v (4.21), symmetric
  Eigen::VectorXd scalar_values(const Eigen::VectorXd& at_sites) const;        ///< the same of a scalar that all images share, as a normal part

 private:
  surface::Symmetry symmetry_;
  bool folded_ = false;  // sites are those of fundamental elements, whose sums are to be folded
  stokes::Sites sites_;
  std::vector<int> own_;
  Eigen::SparseMatrix<double> values_, along_s_, along_t_, weighted_;  // N_A and its derivatives; w_q N_A, shape (N, sites)
  membrane::SymmetricSolver mass_;
  Eigen::SparseMatrix<double> fundamental_, images_;  // rows of scalar sums that tell it; all control values from the fundamental ones
  membrane::DirectSolver scalar_mass_;
};

}  // namespace tanktread::coupling
