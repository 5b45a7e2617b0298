#pragma once
// Control values of a velocity by least squares instead of collocation.

#include <vector>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "membrane/symmetric_solver.hpp"
#include "spline/space.hpp"
#include "stokes/sums/self_field.hpp"
#include "surface/symmetry.hpp"
#include "system/parallel/ranks.hpp"

namespace tanktread::coupling {

/// Least-squares fit of a spline field, with control values v, to a field u at points q between the collocation sites:
///
///   v = (sum_q w_q N(q) N(q)^T)^-1 sum_q w_q N(q) u(q)                                                                     (4.21)
///
/// N(q) are the values of the basis functions at q, and w_q is the part of the unstressed area that belongs to q. The cubic spline that fits a smooth
/// u best has the error h^4 B4(t)/24 times the fourth derivative of u. Here h is the length of an element, t in [0, 1] is the position on the
/// element, and B4 = t^4 - 2 t^3 + t^2 - 1/30 is a Bernoulli polynomial. Collocation at the knots has an error proportional to B4(t) + 1/30. The mean
/// of the collocation error is not 0, so it affects the load of the next shape, the volume and the layers at distant points. The points q are the
/// zeros of B4, two per parametric direction, because the error of the best fit vanishes there.
class VelocityProjection {
 public:
  /// If the scene is symmetric, velocities are evaluated only on the fundamental part of the surface.
  VelocityProjection(const spline::Space& space, const Net& unstressed, const surface::Symmetry& symmetry,
                     const membrane::DirectSolverOptions& direct, const Ranks& ranks);

  const stokes::Sites& sites() const { return sites_; }
  const std::vector<int>& own() const { return own_; }                         ///< sites of this rank, ascending; each site belongs to one rank
  const Eigen::SparseMatrix<double>& values() const { return values_; }        ///< basis functions N_A at the sites, shape (sites, N)
  Net normals(const Net& x) const;                                             ///< unit normals of the surface x at the sites
  Net control_values(const Net& at_sites) const;                               ///< control values v (4.21) of the field u = `at_sites`
  Eigen::VectorXd scalar_values(const Eigen::VectorXd& at_sites) const;  ///< returns the control values of a scalar field with the values `at_sites`
                                                                         ///< at the sites. The field must be equal at all symmetry images, such as a
                                                                         ///< normal component

 private:
  surface::Symmetry symmetry_;
  bool folded_ = false;  // true if one element of each symmetry orbit has sites; sums at images are then added at fundamental points
  stokes::Sites sites_;
  std::vector<int> own_;
  Eigen::SparseMatrix<double> values_, along_s_, along_t_, weighted_;  // values_, along_s_, along_t_: N_A and its derivatives with respect to s and
                                                                       // t, shape (sites, N). weighted_: w_q N_A with w_q of (4.21), shape (N, sites)
  membrane::SymmetricSolver mass_;
  Eigen::SparseMatrix<double> fundamental_, images_;  // fundamental_: adds the sums at image points to the sums at their fundamental points. images_:
                                                      // maps the fundamental values of a symmetric scalar to all control points
  membrane::DirectSolver scalar_mass_;
};

}  // namespace tanktread::coupling
