#pragma once
// Residual of the velocity on rigid bodies between the collocation sites.

#include <span>

#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "stokes/flow/ambient_flow.hpp"
#include "system/capsule_parameters.hpp"
#include "system/targets/collocation.hpp"
#include "system/targets/layers_at.hpp"
#include "system/parallel/ranks.hpp"
#include "system/solids/fluid_walls.hpp"

namespace tanktread::coupling {

/// Residual of the velocity on rigid bodies at Gauss points between the collocation sites. With this residual, (2.11) corrects the forces for the
/// collocation error. Calls are collective.
class RigidResidual {
 public:
  /// The arguments are explained at the constructor of RigidTractions. Only rigid bodies have Gauss points. `walls` must outlive this object.
  RigidResidual(const spline::Space& space, const Net& unstressed, const Net& rest, const CapsuleParameters& parameters, const FluidWalls& walls,
                const Ranks& ranks);

  void repeat(const stokes::PeriodicCell& cell) { layers_.repeat(cell); }

  /// Returns the weighted collocation error int N_A (v - u) dGamma over the bodies, with the spline functions N_A and the fluid velocity u at the
  /// Gauss points. `flow`: v_inf at the Gauss points. `load`, `v`: load and velocity of all particles, whose net is x.
  Net integrated(const Net& x, const Net& load, const Net& v, Net flow);

  const BetweenSites& points() const { return between_; }
  stokes::Evaluations evaluations() const { return layers_.evaluations(); }

 private:
  const FluidWalls& walls_;
  BetweenSites between_;  // Gauss points on the bodies
  LayersBetween layers_;  // layers of all particles and walls at the Gauss points
};

}  // namespace tanktread::coupling
