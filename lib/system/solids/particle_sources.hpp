#pragma once
// Velocity that the particles cause at points off their surfaces: on the wall of a tube, on plates and posts, or in the fluid.

#include <optional>
#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "base/types.hpp"
#include "stokes/layer.hpp"
#include "system/particle.hpp"

namespace tanktread::coupling {

/// Properties of targets of ParticleSources. At targets `first_image_row` and higher, only the images of the particles on the lattice contribute.
/// ParticleSources::prepared sets the other members, with which the double layer is evaluated faster.
struct SourceTargets {
  int first_image_row = stokes::Layer::no_row;
  std::vector<int> nearest{};                        ///< for each target below `first_image_row`, the nearest collocation point of the particles
  std::optional<stokes::Layer::Near> corrections{};  ///< corrections of the double layer by near-singular quadrature
};

/// The particles as sources of flow at points off their surfaces. The load f and the velocity v of the particles, given by control values, cause
///
///   u = -(1/mu) G_C f + (1/8 pi) int_C T q n dGamma,   q = (1 - lambda) v
///
/// where the single layer G_C of the particles includes the factor 1/(8 pi) but not 1/mu. LayersAt is the counterpart for points on the particles.
///
/// Order of calls: set() after construction, or set_reference() and set_contrasts(); set_shape() for each shape; then add_velocity() for any f and v.
/// If several f and v have equal targets, call prepared() once for each shape and pass its result. Nets of particles have one row per control point.
/// Uses no MPI.
class ParticleSources {
 public:
  /// `cell`: lattice whose images of the particles are included; null without a lattice. `how`: see Layer::repeat. `space` must outlive this object.
  ParticleSources(const spline::Space& space, double viscosity, const quadrature::Options& quadrature, const stokes::PeriodicCell* cell,
                  const stokes::Repetition& how);

  /// Sets the unstressed net of the particles, and the area to which loads refer. The arguments are explained at Layer::set_reference.
  void set_reference(const Net& unstressed, stokes::Measure measure = stokes::Measure::reference, std::vector<bool> per_current_area = {});

  /// Sets the viscosity contrast at each control point: 1 - lambda of a deformable particle. The contrast of a rigid body is 0 if its unknown is the
  /// traction (2.40). It is -1 if the unknown is the density w of (2.23), which then takes the place of v. All contrasts are 0 before the first call.
  void set_contrasts(const Eigen::VectorXd& contrasts);
  void set_contrasts(double equal) { set_contrasts(Eigen::VectorXd::Constant(space_.n_points, equal)); }
  void set(const Net& unstressed, std::span<const Particle> particles);  ///< sets the reference and the contrasts of these particles

  /// Sets the control net x of the particles.
  void set_shape(const Net& x);

  /// Prepares `rows` of the targets at the points `at`, for the current shape.
  SourceTargets prepared(const Net& at, std::span<const int> rows, int first_image_row = stokes::Layer::no_row);

  /// Adds u to `rows` of `sum`, at the points `at`. An empty f or v counts as zero. `targets`: result of prepared() for these points, or only the
  /// member `first_image_row`.
  void add_velocity(const Net& f, const Net& v, const Net& at, std::span<const int> rows, Net& sum, const SourceTargets& targets = {});

  /// Returns whether the velocity v has an effect, because at least one contrast is not 0.
  bool has_double() const { return double_layer.has_value(); }

  /// Returns the strength q = (1 - lambda) v of the double layer.
  Net strength(const Net& v) const { return contrasts_.asDiagonal() * v; }

  const Eigen::VectorXd& contrasts() const { return contrasts_; }
  const Eigen::SparseMatrix<double>& collocation() const { return collocation_; }  ///< collocation matrix R
  const Net& sites() const { return sites_; }                                      ///< positions of the collocation points
  stokes::Evaluations evaluations() const;

  stokes::Layer single_layer;
  std::optional<stokes::Layer> double_layer;  ///< double layer without the factor 1 - lambda; set if has_double() is true

 private:
  void require_no_shape() const;  // throws std::logic_error after set_shape(), whose results depend on reference and contrasts

  const spline::Space& space_;
  double viscosity_;
  quadrature::Options quadrature_;
  std::optional<stokes::PeriodicCell> cell_;
  stokes::Repetition how_;
  Eigen::SparseMatrix<double> collocation_;
  stokes::Measure measure_ = stokes::Measure::reference;
  Eigen::VectorXd contrasts_;
  Net sites_;
};

}  // namespace tanktread::coupling
