#pragma once
// Velocity, wall traction, pressure drop and the multipliers of the volume constraints as one linear system.

#include <functional>
#include <string>

#include "base/types.hpp"
#include "system/solids/ducts/tube.hpp"
#include "system/solvers/krylov.hpp"
#include "system/volumes.hpp"

namespace tanktread::coupling {

/// Linear system for particles in a tube. The unknowns are the velocity v (control values), the wall traction f^D, the pressure drop dp and, for
/// each particle, the Lagrange multiplier pi of the constraint (2.8). The equations are
///
///   B v + R^-1 [(1/mu) G_W f^D - dp c] + pi n = r_v,   B = 1 - (1 - lambda) R^-1 H        at the particle                (2.5)
///   (1/mu) G_W f^D - dp c - (1 - lambda) (1 / 8 pi) int T v n dGamma = r_W                at the wall                    (2.6)
///   dp + (1/Q) (1 - lambda) int f_inf.v dGamma = r_p                                                                     (2.7)
///   b.v / (b.n) = 0                                                                       for each particle              (2.8)
///
/// A load that depends on v, such as the load of a body with prescribed motion, contributes to (2.5), (2.6) and (2.7) like f. The terms of such a
/// load are on the left-hand sides. G_W, f^D and c are defined at Tube, H is the double layer of the particle, b = dV/dx, and n = M0^-1 b. In the
/// system, f^D, dp and the row of dp are multiplied by `unit`, so that all unknowns are velocities. The flow rate of the duct flow must be
/// prescribed: the system does not contain its reduction at a prescribed pressure drop.
struct TubeSystem {
  Tube& tube;
  std::function<Net(const Net& v)> load;                        ///< returns the load that depends on v; no rows if there is none
  std::function<Net(const Net& v, const Net& load)> unbounded;  ///< B v, minus the velocity due to the load in unbounded fluid
  std::function<Net(const Net&)> control_values;                ///< applies R^-1
  const VolumeProjection& volume;                               ///< fields b and n of (2.8), and the particles whose volume is constrained
  double unit = 1;                                              ///< tube radius divided by mu: converts f^D and dp to velocities

  /// Returns the system with the named preconditioner. `block triangular` approximates the operator B by the identity and solves for the velocity v
  /// and the multipliers pi, then for the pressure drop dp, then for the wall traction f^D (by the LU factors of the wall). Each right-hand side
  /// includes the unknowns found before. `block diagonal` omits these contributions. `block` uses no preconditioner. The result refers to this
  /// object.
  LinearSystem linear_system(Blocks velocity, const std::string& preconditioner) const;

  /// Returns the right-hand side for the load f. `velocity`: right-hand side r_v of (2.5), in a periodic duct without the images of the particle. The
  /// right-hand sides r_W of (2.6) and r_p of (2.7) are computed from f.
  Eigen::VectorXd right_hand_side(const Net& velocity, const Net& f) const;
};

}  // namespace tanktread::coupling
