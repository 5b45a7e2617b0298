#pragma once
// Velocity, wall traction, pressure drop and the multiplier of the volume as one linear system.

#include <functional>
#include <string>

#include "base/types.hpp"
#include "system/solids/tube.hpp"
#include "system/solvers/krylov.hpp"

namespace tanktread::coupling {

/// Particles in a tube, nothing eliminated: unknowns v (control values), f^D on the wall, dp and the multiplier pi of (2.8),
///
///   B v + R^-1 [(1/mu) G_W f^D - dp c] + pi n = r_v,   B = 1 - (1 - lambda) R^-1 H        at the particle                (2.5)
///   (1/mu) G_W f^D - dp c - (1 - lambda) (1 / 8 pi) int T v n dG = r_W                    at the wall                    (2.6)
///   dp + (1/Q) (1 - lambda) int f_inf.v dG = r_p                                                                         (2.7)
///   b.v / (b.n) = 0                                                                                                      (2.8)
///
/// b = dV/dx, n = M0^-1 b. As blocks of the system f^D and dp are taken times `unit`, so that all unknowns are velocities; the row of dp too.
struct BlockSystem {
  Tube& tube;
  std::function<Net(const Net&)> viscous;          ///< B v
  std::function<Net(const Net&)> control_values;   ///< R^-1
  const Net& flux;                                 ///< b; empty where the volume is free: pi = 0
  const Net& normal;                               ///< n
  double unit = 1;                                 ///< R_T/mu

  /// The system under one of the preconditioners, all with B = 1 and the factored wall: `block triangular` (v and pi, then dp, then f^D, each with
  /// what the ones before do to it), `block diagonal` (none of that), `block` (none at all). It refers to this.
  LinearSystem linear_system(Blocks velocity, const std::string& preconditioner) const;

  /// The right-hand side of the loads: r_v, and what the load f does to wall and pressure drop.
  Eigen::VectorXd right_hand_side(const Net& velocity, const Net& f) const;
};

}  // namespace tanktread::coupling
