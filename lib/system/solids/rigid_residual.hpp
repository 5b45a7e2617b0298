#pragma once
// Residual of the velocity on rigid bodies between the collocation sites. FluidWalls: the walls and solids that bound the fluid.

#include <optional>
#include <span>

#include "base/types.hpp"
#include "quadrature/options.hpp"
#include "spline/space.hpp"
#include "stokes/flow/ambient_flow.hpp"
#include "system/capsule_parameters.hpp"
#include "system/collocation.hpp"
#include "system/layer_pair.hpp"
#include "system/ranks.hpp"
#include "system/solids/tube.hpp"

namespace tanktread::coupling {

/// Boundaries of the fluid that are meshed, other than particles. A member is null if there is no such boundary.
struct FluidWalls {
  Tube* tube = nullptr;
  SolidResponse* solids = nullptr;

  /// Adds to rows `own` of u the velocity that tube and solids cause at points on the particles. `values`: values of the basis functions at the
  /// points. x: net of the particles. `response`, `flow`: responses of tube and solids. Collective if Tube::velocity_at() is.
  void add_velocity_at(const Eigen::SparseMatrix<double>& values, const Net& x, const Tube::Response& response, const Solids::Flow& flow,
                       std::span<const int> own, Net& u) const;
};

/// Residual of the velocity on rigid bodies at Gauss points between the collocation sites. With this residual, (2.11) corrects the forces for the
/// collocation error. Calls are collective.
class RigidResidual {
 public:
  /// The arguments are explained at the constructor of RigidTractions. Only rigid bodies have Gauss points.
  RigidResidual(const spline::Space& space, const Net& unstressed, const Net& rest, const CapsuleParameters& parameters, Ranks& ranks);

  void repeat(const stokes::PeriodicCell& cell) { layers_.repeat(cell); }

  /// Returns the weighted collocation error int N_A (v - u) dGamma over the bodies, with the spline functions N_A and the fluid velocity u at the
  /// Gauss points. `flow`: v_inf at the Gauss points. `load`, `v`: load and velocity of all particles, whose net is x.
  Net integrated(const Net& x, const Net& load, const Net& v, Net flow, const FluidWalls& walls);

  const BetweenSites& points() const { return between_; }
  stokes::Evaluations evaluations() const { return layers_.evaluations(); }

 private:
  double viscosity_;
  Ranks& ranks_;
  BetweenSites between_;  // Gauss points on the bodies
  LayerPair layers_;      // layers of all particles at the Gauss points
};

}  // namespace tanktread::coupling
