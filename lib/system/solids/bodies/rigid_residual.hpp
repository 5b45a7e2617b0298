#pragma once
// Residual of the velocity on rigid bodies between the collocation sites.

#include <optional>
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
#include "system/solids/ducts/wall_residual.hpp"

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

  /// Returns the correction (2.41) of Tube::pressure_of(f) for collocation errors. `of_duct`: flow of the empty duct at the Gauss points, with
  /// amplitude 1. `work`: integral over the bodies of the density z due to this flow times the residual velocity of f. In a channel, also corrects
  /// for the interpolation error of the flow.
  double pressure_correction(const Net& of_duct, const Net& f, double work) const;

  /// Returns the part of pressure_correction() for the interpolation error of the flow.
  double ambient_correction(const Net& of_duct, const Net& f) const;

  /// Returns the residual on the wall of the tube due to the load f (2.42).
  const WallResidual& on_wall(const Net& f);

  const BetweenSites& points() const { return between_; }
  stokes::Evaluations evaluations() const;

 private:
  const FluidWalls& walls_;
  BetweenSites between_;  // Gauss points on the bodies
  LayersBetween layers_;  // layers of all particles and walls at the Gauss points
  std::optional<WallResidual> on_wall_;  // set up at the first call of on_wall()
};

}  // namespace tanktread::coupling
