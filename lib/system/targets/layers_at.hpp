#pragma once
// Velocity of the fluid at a set of points: the only sum of the ambient flow, the layers of the particles and the flow due to walls.

#include <optional>
#include <utility>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "system/capsule_parameters.hpp"
#include "system/parallel/ranks.hpp"
#include "system/solids/fluid_walls.hpp"
#include "system/targets/layer_pair.hpp"

namespace tanktread::coupling {

/// Sources of flow at one shape, by control values of all particles. Absent parts (nets without rows) count as zero and cost nothing.
struct Sources {
  Net load;                                   ///< f of the single layers, force per area
  Net work;                                   ///< virtual work of further loads, like dE/dx: a force F on a control point has the row -F.
                                              ///< Equation::add_loads_of_work adds these loads to `load`
  Net density;                                ///< v: the double layers have the density (1 - lambda) v, or -w on rigid bodies (viscosity_contrast)
  std::optional<FluidWalls::Response> walls;  ///< tractions on walls and the pressure drop, and the flow of plates and posts
  bool ambient = false;                       ///< whether the ambient flow is included

  void add_load(Net part) { add(load, std::move(part)); }
  void add_work(Net part) { add(work, std::move(part)); }
  void add_density(Net part) { add(density, std::move(part)); }

 private:
  static void add(Net& to, Net part) { to = to.size() > 0 ? Net(to + part) : std::move(part); }
};

/// Returns whether the ambient velocity is needed at the targets. Otherwise it is affine, and exact at the control points.
inline bool flow_at_targets(const FluidWalls& walls, const stokes::AmbientFlow& flow) { return walls.any() || !flow.affine(); }

/// One set of target points, and the operators by which the sources cause velocities there: exact, assembled or frozen. Calls are collective and
/// return equal nets on all ranks.
class LayersAt {
 public:
  virtual ~LayersAt() = default;
  virtual Net ambient() = 0;  ///< ambient velocity v_inf at the targets
  /// Returns the control values of the ambient velocity if they are known without its values at the targets, otherwise no rows. An affine flow is
  /// a spline with the values at the control points as its control values.
  virtual Net ambient_control_values() { return {}; }
  virtual Net of_particles(const Net& load, const Net& density) = 0;  ///< D v - (1/mu) A f of (4.2) at the targets
  virtual void add_walls(const FluidWalls::Response& walls, Net& u) = 0;
};

/// Returns the velocity that the sources cause at the targets `at` (2.22): the only sum of the ambient flow, the layers and the walls. If
/// `control_values` is given and those of the ambient velocity are known, it receives these, and the result omits the ambient velocity.
Net velocities(LayersAt& at, const Sources& sources, Net* control_values = nullptr);

/// Targets between the collocation sites, at which residuals are integrated.
class LayersBetween : public LayersAt {
 public:
  /// `values`: values of the basis functions at the points `sites`. `unstressed`, `quadrature`: see LayerPair. References must outlive this object.
  LayersBetween(const spline::Space& space, const stokes::Sites& sites, const Eigen::SparseMatrix<double>& values, const Net& unstressed,
                const CapsuleParameters& parameters, const quadrature::Options& quadrature, const FluidWalls& walls, const Ranks& ranks);

  void repeat(const stokes::PeriodicCell& cell) { layers_.repeat(cell); }
  /// Sets the net of the particles, to which the walls must be set, and the ambient velocity at the points.
  void set_shape(const Net& x, Net ambient);

  Net ambient() override { return ambient_; }
  Net of_particles(const Net& load, const Net& density) override;
  void add_walls(const FluidWalls::Response& walls, Net& u) override;
  stokes::Evaluations evaluations() const { return layers_.evaluations(); }

 private:
  const Eigen::SparseMatrix<double>& values_;
  const FluidWalls& walls_;
  const Ranks& ranks_;
  LayerPair layers_;
  Net x_, ambient_;
};

}  // namespace tanktread::coupling
