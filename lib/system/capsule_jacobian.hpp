#pragma once
// The Jacobian of Capsule, and the linear systems of an implicit step.

#include <cmath>
#include <optional>
#include <vector>

#include "membrane/area_constraint.hpp"
#include "system/frozen/frozen_layers.hpp"
#include "system/velocity_solver.hpp"

namespace tanktread::coupling {

/// The Jacobian J = dv/dx of the velocity (4.2) at the shape of the last linearisation. Its layers are frozen: they are kept from an earlier shape
/// (4.3). B denotes the operator of (4.2) with frozen layers. J and B include the response of a tube, and omit plates and posts. The rows of rigid
/// bodies in J are 0, because their motion is not stiff. If velocities conserve the volumes, J includes the volume projection P (2.8). Without P, the
/// frozen layers of a deformed capsule would give J modes that inflate the capsule. In a tube such a mode grows (eigenvalue +19 in the units of the
/// deck capsule_cylinder) and halves the size of the steps. P also makes the correction e2 of (4.30), which TR-BDF2 computes with J, conserve the
/// volumes. Calls are collective.
class CapsuleJacobian {
 public:
  /// Changes due to a displacement dx and to additional loads with the virtual work `added_work`. `rate`: see velocity_change() and step_change().
  /// `slip`: change of the fluid velocity minus the velocity of the control points; empty if no control points slide along an interface. `added`:
  /// rows of the equations that the program adds.
  struct RateChange {
    Net rate, slip;
    Eigen::VectorXd added{};
  };

  /// `solver`: computes the velocity v; this object increases its counters of operations. `frozen`: its layers, frozen. References must outlive this
  /// object.
  CapsuleJacobian(VelocitySolver& solver, FrozenLayers& frozen);

  /// Linearises at x. `energy_gradient`: dE/dx at x, required only if control points slide. `sums`: surface integrals that Membranes::work computed
  /// at x. `slip`: slip at x, required only if control points slide; empty if it is unknown. `solution`: unknowns at x, required only if the program
  /// adds equations.
  void linearise(const Net& x, const Net& energy_gradient, const std::vector<Net>& sums, const Slip& slip, const BlockVector& solution);

  /// Returns an approximation of B^-1 rhs with the operator B of (4.2), solved to the relative residual 0.05.
  Net inverse_product(const Net& rhs) { return fluid_velocity(rhs, 0.05); }

  /// Returns these blocks, followed by the blocks of the equations that the program adds, unless control points slide: a step then omits them.
  std::vector<Block> with_added(std::vector<Block> blocks) const { return interface_ ? blocks : added_.all.after(std::move(blocks)); }

  /// Returns B v with the operator B of (4.2), or v if control points slide along an interface, as `rate`, and the rows of the added equations.
  RateChange velocity_product(const Net& v) { return interface_ ? RateChange{v, {}} : parted(product(v, {}, {}, 0, {}), row_weight()); }
  RateChange velocity_change(const Net& dx, const Net& added_work);  ///< returns J dx as `rate`
  /// Returns the left-hand side of an implicit step as `rate`: B (dx - shift J dx), or dx - shift J dx if control points slide. `slip` equals
  /// velocity_change(dx, added_work).slip. If no control points slide, applies each layer only once. `added`: unknowns of the added equations, times
  /// the shift; they are zero if it is empty. Their rows are taken for the velocity dx, because displacements satisfy the same linear conditions as
  /// velocities.
  RateChange step_change(const Net& dx, const Eigen::VectorXd& added, double shift, const Net& added_work);

  /// Applies an approximate inverse of the matrix of `solve`, for the shift of the latest call of solve_step(), to rows of the particles and of the
  /// added equations.
  RateChange step_preconditioner(const Net& r, const Eigen::VectorXd& added) const;

  /// Returns true if step_preconditioner() is not the identity.
  bool has_preconditioner() const { return area_ || !added_.all.empty(); }

  /// Solves the linear system of an implicit step with the shift gamma dt to the relative residual `tolerance`, and counts the solve. The tolerance
  /// is multiplied by 10/lambda if the largest viscosity ratio lambda of the deformable particles is between 10 and 2e4 and no control points slide.
  /// If all control points move with the fluid, the rows of the shape are (B - shift (B J + E)) delta = rhs (4.3) with the secant correction E
  /// (4.13) of J, which do not require the inverse of B. If control points slide along an interface, they are
  /// (1 - shift (N B^-1 B J + T W + E)) delta = rhs. Here N dv + T W delta is the change of the mesh velocity (4.6) due to a change dv of the fluid
  /// velocity and the displacement delta.
  Eigen::VectorXd solve_step(double shift, const Apply& product, const Apply& precondition, const Eigen::VectorXd& rhs, double tolerance);

  /// Returns the displacement along which a volume is restored. By default it is the direction c of (2.8). If the membrane nearly conserves area, it
  /// is the solution of an implicit step with the right-hand side c. The displacement c itself would change the area, and the resulting stress,
  /// proportional to the large dilatation modulus, would affect the next step.
  Net inflation(const Net& c);

  /// Changes the initial guess y of a stage so that membranes that nearly conserve area have the same local area as in the shape `before` the stage.
  void improve_start(Net& y, const Net& before, double shift);

 private:
  std::vector<Mat3> gradients_at(const Net& x) const;
  BlockVector product(const Net& v, const Eigen::VectorXd& added, const Net& dx, double shift, const Net& added_work);
  RateChange parted(const BlockVector& r, double weight) const;
  Eigen::Index n_added() const { return unknowns_->size() - 3 * frozen_.n_points(); }  // number of unknowns of the added equations
  double row_weight() const { return std::sqrt(static_cast<double>(frozen_.n_points())); }
  Net without_pressure(Net work, const Net& db) const;
  Net fluid_velocity(const Net& rhs, double tolerance);
  Net fluid_velocity_change(const Net& dx, const Net& added_work);
  double tolerance_factor() const;

  const CapsuleParameters& parameters_;
  const stokes::AmbientFlow& flow_;
  const bool flow_at_sites_;  // whether the ambient velocity is evaluated at the sites. Otherwise its uniform gradient acts on the control points
  const Targets& targets_;
  Membranes& membranes_;
  const Volumes& volumes_;
  FrozenLayers& frozen_;
  const bool explicit_;         // see VelocitySolver::is_explicit
  Tube* tube_;                  // null if there is no tube
  InterfaceMotion* interface_;  // null if no control points slide
  OperationCounts& counts_;
  std::optional<membrane::AreaConstraint> area_;  // set if a membrane integrates its area elasticity by a separate quadrature
  /// Equations that the program adds; at x_, with the unknowns there. None are at x_ if control points slide.
  struct Added {
    const UserEquations& all;
    std::vector<std::shared_ptr<const Equation>> here;
    BlockVector solution;
  };
  Added added_;
  std::shared_ptr<const Layout> unknowns_;  // velocities of the particles, and unknowns of the added equations
  struct {
    Krylov step, inner;
  } solvers_;
  double latest_shift_ = 0;      // shift gamma dt of the implicit system solved last
  VolumeProjection projection_;  // projection P (2.8); not active if the volumes are free
  struct Pressure {
    spline::Block block;
    double p;
  };
  std::vector<Pressure> pressures_;  // pressures p (4.35) of all particles whose control points slide
  Net x_;                            // shape of the last linearisation
  std::vector<Mat3> gradients_;  // velocity gradients of the ambient flow at the collocation sites; set if flow_at_sites_ is true
};

}  // namespace tanktread::coupling
