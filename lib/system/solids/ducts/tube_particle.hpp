#pragma once
// Data of the particle in a tube, which change with its shape.

#include <optional>
#include <vector>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "membrane/direct_solver.hpp"
#include "surface/geometry.hpp"
#include "system/frozen/frozen_pair.hpp"
#include "system/solids/ducts/channel_flow.hpp"
#include "system/solids/ducts/duct.hpp"
#include "system/solids/ducts/tube.hpp"
#include "system/solvers/options.hpp"
#include "system/targets/layer_pair.hpp"

namespace tanktread::coupling {

/// The surface of all particles in a tube, in the frame of the wall: the velocity that it causes at the wall, the weights of its load and velocity in
/// the pressure drop (2.7), and the frozen operators of the Jacobian. set_shape() sets all members that depend on the shape, except `frozen`, which
/// freeze() sets. Calls are collective.
struct Tube::ParticleData {
  /// References must outlive this object.
  ParticleData(const spline::Space& space, const TubeParameters& parameters, Duct& duct, Phases& phases);

  void set_particles(const Net& unstressed, std::span<const Particle> particles);

  /// Sets the shape. `x1`: position along x1 of the origin of the wall's frame.
  void set_shape(const Net& x, double x1);

  /// Stores the operators of the current shape as low-precision blocks.
  void freeze();

  /// Velocities that the load f and the velocity v of the particle cause, for rank-owned rows. `at_wall`: at the targets on the wall. `at_sites`: at
  /// the particle's collocation points, due to the images of the particle in a periodic duct only; no rows in other ducts. An empty net counts as
  /// zero.
  struct Cause {
    Net at_wall, at_sites;
  };
  Cause cause(const Net& f, const Net& v);

  /// Returns the weights w of the velocity v: its double layer causes the flow rate w.v along the duct. Cached for the current shape.
  const Net& flow_of_velocity();

  bool has_double() const { return layers->double_layer.has_value(); }  ///< whether the velocity v has an effect
  bool parallel() const { return surface::properties(duct.wall().surface().kind).parallel_flow; }

  const spline::Space& space;
  TubeParameters parameters;
  Duct& duct;
  Ranks ranks;
  surface::Geometry geometry;
  Eigen::SparseMatrix<double> collocation;  ///< collocation matrix R
  membrane::DirectSolver from_sites;        ///< factors of R, to compute control values from values at the sites
  std::optional<LayerPair> layers;          ///< layers of the particle at points off it; set by set_particles()

  double origin = 0;  ///< x1 of the origin of the wall's frame, which is the particle's centroid in a straight open tube
  Net shape;          ///< net of the particle in the frame of the wall
  PointsOff sites;    ///< collocation points of the particle, prepared for the wall's layer if lambda != 1. `sites.own` is set by the constructor
  PointsOff targets;  ///< targets of the wall; in a periodic duct also the particle's collocation points, in later rows
  InFlow in_flow;     ///< see Tube::in_flow()

  /// Operators of the Jacobian: layers of the particle at the wall and, due to its images in a periodic duct, at its own sites; layer of the wall at
  /// these sites.
  struct Frozen {
    FrozenPair on_wall, of_images;
    FrozenOperator wall;
    bool images = false;  ///< whether `of_images` is set: in a periodic duct, unless it would be large
    InFlow in_flow;
  };
  Frozen frozen;

 private:
  void weigh_pressure();
  Net ambient() const;

  Net flow_of_velocity_;
};

}  // namespace tanktread::coupling
