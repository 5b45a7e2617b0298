#pragma once
// Result of VelocitySolver: loads, unknowns and velocities at one shape.

#include <optional>
#include <vector>

#include "base/types.hpp"
#include "system/blocks/block_vector.hpp"
#include "system/interface_motion.hpp"
#include "system/solids/bodies/rigid_particles.hpp"
#include "system/solids/ducts/tube.hpp"

namespace tanktread::coupling {

/// Virtual work of the loads. `work`: dE/dx of all loads minus the virtual work of the additional forces (VelocitySolver::set_forces), one row per
/// control point; 0 for rigid bodies. `sums`: surface integrals on which the loads depend (see Loads), summed over all ranks.
struct WorkOfLoads {
  Net work;
  std::vector<Net> sums;
};

/// Solution of (4.2) at one shape. Nets have one row per control point of all particles.
struct SolvedShape {
  double error = 0;  ///< allowed error of the velocity (Capsule::norm per unit of time), if larger than the error due to Solvers/tolerance
  Net velocity;      ///< velocity of the control points
  Net fluid;         ///< velocity of the fluids; no rows if no control point slides
  Slip slip;         ///< slip of the fluids along the meshes of interfaces; empty if no control point slides
  /// unknowns of the velocity system: the fluid velocity, or w (2.23) in the rows of rigid bodies, or their velocity if the unknown is the traction.
  /// On a lattice, a solve stores the velocities of the particles' images in the cell, unlike in `velocity` and `fluid`. Evaluation::find_unknowns
  /// stores the velocities of the particles themselves. Only walls use these, and with walls the velocities of particles and images are equal
  Net unknowns;
  BlockVector solution;  ///< all unknowns; set only if the program adds equations
  Net added_work;        ///< virtual work of the loads of these equations (Sources::work); no rows if there are none
  WorkOfLoads virtual_work;
  Net load;                                ///< see Evaluation::load
  std::optional<Tube::Response> response;  ///< response of the tube; not set if a velocity system was solved, because the solution changes it
  std::optional<RigidParticles> rigid;     ///< rigid bodies with their motion, if there are any
};

}  // namespace tanktread::coupling
