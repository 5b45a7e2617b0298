#pragma once
// Unknowns of the particles, of the wall of a duct and of the volume constraints as one linear system.

#include <functional>
#include <string>

#include "base/types.hpp"
#include "system/solids/ducts/tube.hpp"
#include "system/solvers/krylov.hpp"
#include "system/volumes.hpp"

namespace tanktread::coupling {

/// The linear system for the velocities at one shape. Its unknowns are blocks. Every block but the first one is optional:
///
///   particles        y, three components per control point: the velocity v of a deformable particle, or the density w (2.23) on a rigid body
///   wall traction    f^D, and the pressure drop dp, in a duct
///   multipliers      one Lagrange multiplier pi of the constraint b.v = 0 per deformable particle
///
/// The equations are
///
///   B y + R^-1 [(1/mu) G_W f^D - dp c] + pi n = r_v       at the particles                (2.5)
///   (1/mu) G_W f^D - dp c - u(y) = r_W                    at the wall                     (2.6)
///   dp - dp(y) = r_p                                                                      (2.7)
///   b.v / (b.n) = 0                                       for each deformable particle    (2.8)
///
/// B is the operator of (4.2), u(y) the velocity that the particles cause at the wall, and dp(y) the pressure drop that they cause. Both include the
/// effect of loads that depend on y. G_W, f^D and c are defined at Tube, b = dV/dx, and n = M0^-1 b. In the system, f^D, dp and the row of dp are
/// multiplied by `unit`, so that all unknowns are velocities.
///
/// In a periodic duct the left-hand side of (2.5) also contains the velocity due to the images of the particles. If a scene has a wall or constrained
/// volumes whose block is left out, this block has been eliminated: the wall by its factors, which makes its response a part of B, and the
/// multipliers by the projection P of (2.8), which replaces B by P B P. An eliminated block costs no unknowns, but each product with B includes its
/// response. If the wall is an unknown, the flow rate of the duct must be prescribed: the system does not contain the reduction of the flow rate at a
/// prescribed pressure drop.
struct BlockSystem {
  std::function<Net(const Net& y)> load;                         ///< returns the load that depends on y; no rows if there is none
  std::function<Net(const Net& y, const Net& load)> particles;  ///< returns B y for load(y), without P; includes the response of eliminated walls
  std::function<Net(const Net&)> control_values;                 ///< applies R^-1
  const VolumeProjection& volume;                                ///< fields b and n of (2.8), and the particles whose volume is constrained
  bool multipliers = false;                                      ///< whether the multipliers are unknowns; otherwise P eliminates them
  Tube* tube = nullptr;                                          ///< duct whose wall traction and pressure drop are unknowns; null if there is none
  double unit = 1;                                               ///< duct radius divided by mu: converts f^D and dp to velocities
  Apply of_particles{};                                          ///< optional: approximate inverse of B, or of P B P + 1 - P

  /// Returns the system. The preconditioner uses `of_particles` for B, or the identity if it is not set. It solves for y and pi, then for dp, then
  /// for f^D by the LU factors of the wall. With `form` = `block triangular`, each right-hand side includes the unknowns found before. `block
  /// diagonal` omits these contributions. With `block`, there is no preconditioner. Without a wall among the unknowns, `form` has no effect.
  /// `names`: names and sizes of the particles' unknowns. The result refers to this object.
  LinearSystem linear_system(Blocks names, const std::string& form) const;

  /// Returns the right-hand side for the load f. `velocity`: right-hand side r_v of (2.5) without P; in a periodic duct whose wall is an unknown,
  /// also without the images of the particles. The right-hand sides r_W of (2.6) and r_p of (2.7) are computed from f.
  Eigen::VectorXd right_hand_side(const Net& velocity, const Net& f) const;
};

}  // namespace tanktread::coupling
