#pragma once
// Single and double layer of all particles at one set of points, on the particles or off them.

#include <functional>
#include <optional>
#include <span>

#include <Eigen/SparseCore>

#include "stokes/layer.hpp"
#include "system/particle.hpp"
#include "system/targets/points_off.hpp"

namespace tanktread::coupling {

/// The single layer G_C and the double layer of (2.22) of all particles at given points, in a medium or on a lattice. The load f and the velocity v
/// of the particles, given by control values, cause there
///
///   u = -(1/mu) G_C f + (1/8 pi) int_C (1 - lambda) T v n dGamma
///
/// where G_C includes the factor 1/(8 pi) but not 1/mu. For rigid bodies, -1 or 0 replaces 1 - lambda (viscosity_contrast), and the density w of
/// (2.23) replaces v. All velocities that particles cause are computed by this class: on the particles, between their collocation points, on walls
/// and in the fluid. Order of calls: repeat() on a lattice; set_shape() for each shape; then add() for any f and v. Uses no MPI.
class LayerPair {
 public:
  /// `points`: points on the particles; empty if all points are off them. `unstressed`: control net of the unstressed surfaces, to which the loads of
  /// membranes refer. `medium`: medium that contains all particles, or null. `space` and `points` must outlive this object.
  LayerPair(const spline::Space& space, const stokes::Sites& points, const Net& unstressed, std::span<const Particle> particles,
            const quadrature::Options& quadrature, double viscosity, const stokes::Medium* medium = nullptr);

  /// Sets the cell of the lattice. Must be called again when the cell deforms. `how`: see Layer::repeat.
  void repeat(const stokes::PeriodicCell& cell, const stokes::Repetition& how = {});

  /// Sets the control net x of all particles for both layers.
  void set_shape(const Net& x);

  /// Returns the points `at` off the particles, prepared for the current shape, so that several f and v cost less. `own`: rows to evaluate.
  PointsOff prepared(Net at, std::vector<int> own, int first_image_row = stokes::Layer::no_row);

  /// Add the velocity u that the load f and the velocity v cause to the rows `own` of `sum`. An empty f or v counts as zero. The first one is for
  /// points on the particles.
  void add(const Net& f, const Net& v, std::span<const int> own, Net& sum);
  void add(const Net& f, const Net& v, const PointsOff& points, Net& sum);

  /// Returns weights w, one row per control point, for the current shape: the integral of f.a over the particles is w.f for any load f. `field(x)`
  /// returns a at the points x.
  Net weights_of_load(const std::function<Net(const Net& x)>& field) const;
  /// Returns weights w, one row per control point, for the current shape: the integral of (1 - lambda) v.t over the particles is w.v for any velocity
  /// v. `field(x, n)` returns t at the points x, as a linear function of the normals n, which are multiplied by areas.
  Net weights_of_velocity(const std::function<Net(const Net& x, const Net& n)>& field) const;
  Net at_nodes(const Net& field);  ///< returns a field, given by control values, at the points x of weights_of_load()

  stokes::Evaluations evaluations() const;  ///< kernel evaluations of this rank

  stokes::Layer single_layer;
  std::optional<stokes::Layer> double_layer;  ///< not set if the factors (viscosity_contrast) of all particles vanish
  stokes::Measure measure;                    ///< area (unstressed or current) to which the loads refer

 private:
  template <class Apply>
  void add_layers(const Net& f, const Net& v, std::span<const int> own, const Apply& apply, Net& sum);

  double viscosity_;
  std::optional<stokes::PeriodicCell> cell_;
  Eigen::SparseMatrix<double> collocation_;  // collocation matrix R; empty if the points are on the particles
  Net sites_;                                // collocation points of the current shape; likewise
};

}  // namespace tanktread::coupling
