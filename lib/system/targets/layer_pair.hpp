#pragma once
// Single and double layer of all particles at one set of points.

#include <optional>
#include <span>

#include "stokes/layer.hpp"
#include "system/particle.hpp"

namespace tanktread::coupling {

/// The single layer and the double layer of (2.22) of all particles at given points, in a medium or on a lattice. The velocity of the particles, the
/// residual of rigid bodies and the power balance use this class, so that all of them use the kernels of the same medium.
class LayerPair {
 public:
  /// `points`: points on the particles. `unstressed`: control net of the unstressed surfaces, to which the loads of membranes refer. `medium`:
  /// medium that contains all particles, or null. References, except `unstressed` and `medium`, must outlive this object.
  LayerPair(const spline::Space& space, const stokes::Sites& points, const Net& unstressed, std::span<const Particle> particles,
            const quadrature::Options& quadrature, const stokes::Medium* medium);

  /// Sets the cell of the lattice. Must be called again when the cell deforms.
  void repeat(const stokes::PeriodicCell& cell);

  /// Sets the control net x of all particles for both layers.
  void set_shape(const Net& x);

  /// Computes rows `own` of D v - A f/mu at the points, with the control values v of a velocity and f of a load, and the viscosity mu. `u`: shape
  /// (number of points, 3).
  void apply(const Net& f, const Net& v, double viscosity, std::span<const int> own, Net& u);

  stokes::Evaluations evaluations() const;  ///< kernel evaluations of this rank

  stokes::Layer single_layer;
  std::optional<stokes::Layer> double_layer;  ///< not set if the factors (viscosity_contrast) of all particles vanish
  stokes::Measure measure;                    ///< area (unstressed or current) to which the loads refer
};

}  // namespace tanktread::coupling
