#pragma once
// Target points on the particles at which velocities are evaluated.

#include <optional>
#include <utility>
#include <vector>

#include <Eigen/SparseCore>

#include "system/capsule_parameters.hpp"
#include "system/parallel/row_share.hpp"
#include "system/targets/velocity_projection.hpp"

namespace tanktread::coupling {

/// The targets: the points on all particles at which velocities are evaluated. They are the collocation sites or, with a least-squares projection,
/// the points of VelocityProjection. The Jacobian and some conditions use the collocation sites in both cases.
class Targets {
 public:
  /// References must outlive this object.
  Targets(const spline::Space& space, const Net& unstressed, const CapsuleParameters& parameters, const RowShare& layout);

  const VelocityProjection* projection() const { return projection_ ? &*projection_ : nullptr; }  ///< null if velocities are collocated
  const stokes::Sites& sites() const { return projection_ ? projection_->sites() : space_.collocation; }
  const std::vector<int>& own() const { return projection_ ? projection_->own() : layout_.points(); }  ///< targets of this rank, ascending
  /// Returns the matrix that maps control values to values at the targets, shape (targets, N).
  const Eigen::SparseMatrix<double>& values() const { return projection_ ? projection_->values() : at_sites_; }
  const Eigen::SparseMatrix<double>& at_sites() const { return at_sites_; }      ///< collocation matrix R (4.2)
  const membrane::SymmetricSolver& collocation() const { return collocation_; }  ///< factors of R
  Net zero() const { return Net::Zero(values().rows(), 3); }                     ///< velocity 0 at the targets

  /// Gathers the velocity at the targets on all ranks. `shared`: see RowShare::gather. Collective.
  void gather(bool shared, Net& at_targets) const;

  /// Returns the control values of the velocity whose values at the targets are `at_targets`. With collocation, this function is collective and
  /// divides the work among the ranks.
  Net control_values(Net at_targets) const;

  /// Returns the control values of the field whose values at the collocation sites are `at_sites`. Collective.
  Net collocated(Net at_sites) const { return layout_.solved(collocation_, std::move(at_sites)); }

 private:
  const spline::Space& space_;
  const RowShare& layout_;
  std::optional<VelocityProjection> projection_;
  Eigen::SparseMatrix<double> at_sites_;
  membrane::SymmetricSolver collocation_;
};

}  // namespace tanktread::coupling
