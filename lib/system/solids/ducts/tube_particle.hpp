#pragma once
// Data of the particle in a tube, which change with its shape.

#include <optional>
#include <vector>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "membrane/direct_solver.hpp"
#include "surface/geometry.hpp"
#include "system/solids/ducts/tube.hpp"
#include "system/solids/ducts/wall.hpp"
#include "system/frozen/frozen_operator.hpp"
#include "system/targets/layer_pair.hpp"
#include "system/solvers/options.hpp"

namespace tanktread::coupling {

/// The surface of all particles in a tube, in the frame of the wall: the velocity that it causes at the wall, the weights of its load and velocity in
/// the pressure drop (2.7), and the frozen operators of the Jacobian. set_shape() sets all members that depend on the shape, except `frozen`, which
/// freeze() sets. Calls are collective.
struct Tube::ParticleData {
  ParticleData(const spline::Space& space, const TubeParameters& parameters, const Wall& wall, Phases& phases);

  void set_particles(const Net& unstressed, std::span<const Particle> particles, const Wall& wall);

  /// Sets the shape. `x1`: position along x1 of the origin of the wall's frame. `pressure_drop`: pressure drop of the empty duct.
  void set_shape(const Net& x, double x1, const stokes::DuctFlow& flow, Wall& wall, double pressure_drop);

  /// Stores the operators of the current shape as low-precision blocks. `pressure_of_wall`: weights with which a velocity on the wall contributes to
  /// the pressure drop dp, or empty. If it is not empty, also computes the weights with which the particle's velocity v contributes to dp: the
  /// product of `pressure_of_wall` and the double layer. For accuracy, the rows of the double layer are rounded only afterwards.
  void freeze(Wall& wall, const Net& pressure_of_wall);

  /// Velocities that the load f and the velocity v of the particle cause, for rank-owned rows. `at_wall`: at the targets on the wall. `at_sites`: at
  /// the particle's collocation points, due to the images of the particle in a periodic duct only; no rows in other ducts. An empty net counts as
  /// zero.
  struct Cause {
    Net at_wall, at_sites;
  };
  Cause cause(const Net& f, const Net& v);

  /// Returns the weights w of the velocity v: its double layer causes the flow rate w.v along the duct. Cached for the current shape.
  const Net& flow_of_velocity(const Wall& wall);

  bool has_double() const { return layers->double_layer.has_value(); }  ///< whether the velocity v has an effect

  const spline::Space& space;
  TubeParameters parameters;
  std::vector<int> own;  ///< rank-owned points
  Ranks ranks;
  surface::Geometry geometry;
  Eigen::SparseMatrix<double> collocation;  ///< collocation matrix R
  std::optional<LayerPair> layers;    ///< layers of the particle at points off it, with its shape in the wall's frame; set by set_particles()
  membrane::DirectSolver from_sites;  ///< factors of R, to compute control values from values at the sites
  bool periodic;                      ///< whether the duct is periodic

  Net shape, sites;                            ///< net and collocation points of the particle in the frame of the wall
  double origin = 0;                           ///< x1 of the origin of the wall's frame, which is the particle's centroid in a straight open tube
  Net inlet;                                   ///< velocity c (2.5) per unit pressure drop, at the sites
  Net ambient, interpolated_ambient;           ///< duct flow v_inf at the sites, and its control values (in a channel only)
  Net weights_of_load, weights_of_velocity;    ///< weights of f and v in dp (2.7). Weights of v are set only in a straight tube, if lambda != 1
  PointsOff targets;                           ///< targets of the wall; in a periodic duct also the particle's collocation points, in later rows
  std::optional<stokes::Layer::Near> wall_on_sites;  ///< corrections of the wall's layer at the particle's sites; set if lambda != 1

  /// Operators of the Jacobian: layers of the particle at the wall and, due to its images in a periodic duct, at its own sites; layer of the wall at
  /// these sites.
  struct Frozen {
    FrozenOperator single, dual, single_of_images, dual_of_images, wall;
    bool images = false;  ///< whether the operators of images are set: in a periodic duct, unless they would be large
    Net inlet, ambient, weights_of_load, weights_of_velocity;
  };
  Frozen frozen;

 private:
  void weigh_pressure(const stokes::DuctFlow& flow, bool parallel);
  Net ambient_of(const stokes::DuctFlow& flow) const;

  Net flow_of_velocity_;
};

/// Points of the wall between its collocation points, at which wall_residual() evaluates the velocity, and the single layer for these points.
struct Tube::BetweenSitesOfWall {
  BetweenSitesOfWall(const surface::TubeWall& wall, const std::optional<stokes::PeriodicCell>& cell, const BetweenSites& between,
                     const quadrature::Options& options);

  Net at;                               ///< positions
  Eigen::SparseMatrix<double> weights;  ///< see BetweenSites
  stokes::Layer layer;                  ///< single layer of the wall at the points
};

}  // namespace tanktread::coupling
