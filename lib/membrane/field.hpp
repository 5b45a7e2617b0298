#pragma once
// Interface of fields: unknowns on a surface that evolve with it and contribute to its load.

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "base/types.hpp"
#include "membrane/load.hpp"
#include "spline/space.hpp"
#include "surface/metrics.hpp"
#include "surface/symmetry.hpp"

namespace tanktread::membrane {

/// A field with the coefficients q on a surface with the control net x, for example a surfactant concentration or a viscoelastic strain. q is scaled
/// to order 1. The slip is the velocity of the fluid minus the velocity of the control points, as control values of shape (N, 3); an empty slip is 0.
/// Uses no MPI: every rank holds the whole field.
class Field {
 public:
  virtual ~Field() = default;

  virtual Eigen::Index size() const = 0;                      ///< number of coefficients
  virtual Eigen::VectorXd start(const Net& shape) const = 0;  ///< initial coefficients q of a run that starts with this shape

  /// Sets the shape x and the coefficients q to which load(), rate() and energy() refer. Throws RunFailure if the state is not admissible.
  virtual void set_state(const Net& x, const Eigen::VectorXd& q) = 0;

  virtual Net load() const = 0;                              ///< load as virtual work (3.6), shape (N, 3), added to dE/dx; no net force or torque
  virtual Eigen::VectorXd rate(const Net& slip) const = 0;   ///< dq/dt
  virtual double energy() const = 0;                         ///< energy stored in the field
  /// power that the field dissipates as heat in the membrane; dissipation in the surface flow is not included
  virtual double dissipation() const { return 0; }

  /// Stores the state set last and the slip (fluid minus control-point velocity). value_change(), load_change(), rate_change() and solve() use the
  /// stored data.
  virtual void linearise(const Net& slip) = 0;

  /// Returns the change of the values of the field (concentration or strain) if the shape changes by dx and the coefficients by dq.
  virtual Eigen::VectorXd value_change(const Net& dx, const Eigen::VectorXd& dq) const = 0;
  virtual Net load_change(const Net& dx, const Eigen::VectorXd& value_change) const = 0;
  virtual Eigen::VectorXd rate_change(const Net& dx, const Eigen::VectorXd& value_change, const Net& slip_change) const = 0;

  /// Stores the shape x for solve(); the state stored by linearise() is kept. May overwrite the state set by set_state(), which must then be called
  /// again.
  virtual void freeze(const Net& /*x*/) {}

  /// Returns an approximation of (1 - shift A)^-1 r, with the Jacobian A = d(rate)/dq.
  virtual Eigen::VectorXd solve(double shift, const Eigen::VectorXd& r) const = 0;

  /// Returns whether the field follows the shape with a short relaxation time. Implicit solvers then eliminate the coefficients of the field.
  virtual bool follows_shape() const { return false; }

  /// Corrects the approximate solution dq of (1 - shift A) dq = r, A = d(rate)/dq, if the motion conserves a weighted sum of the coefficients of the
  /// field (see conserved()). After the correction, the weighted sums of dq and of r are equal to round-off.
  virtual void conserve(const Eigen::VectorXd& /*r*/, Eigen::VectorXd& /*dq*/) const {}

  /// Returns dq/dt, at the state set last, if the control points slide along the surface with this velocity while the material is at rest.
  virtual Eigen::VectorXd relabelled(const Net& mesh_velocity) const = 0;

  /// Returns the coefficients q of this field for the surface with the shape x, transferred from the field `from` of the same kind on another mesh of
  /// the same surface. The state of `from` must be set. `site` maps a parametric point of this mesh to the parametric point at the same position on
  /// the mesh of `from`.
  virtual Eigen::VectorXd transferred(const Field& from, const Net& x, const std::function<spline::Site(const spline::Site&)>& site) const = 0;

  /// Returns the gradient, with respect to the coefficients q, of a weighted sum of q that the motion conserves; empty if there is none.
  virtual Eigen::VectorXd conserved() const { return {}; }

  /// Returns, for the state set last, the values of the columns of the time series that are registered with the field. snapshot() returns the
  /// quantities that the field writes to snapshots.
  virtual std::vector<double> values() const { return {}; }
  virtual std::vector<SurfaceValues> snapshot() const { return {}; }

  /// Returns a function that evaluates the field, scaled to order 1, at a parametric point in the state set last. Mesh refinement reduces the
  /// estimated error e(q) of these values (1.5). If the function is empty, refinement ignores the field.
  virtual surface::FieldsAt values_at() const { return {}; }

  /// Returns, for each coefficient, the index of its image under the symmetry and the sign by which it is multiplied. An empty result means that the
  /// images are unknown: the field is then not made symmetric, and modes (4.16) are computed on the whole surface.
  virtual std::vector<std::pair<int, double>> images(const surface::Image&) const { return {}; }
};

using FieldParts = deck::Parts<std::unique_ptr<Field>(const ParticleSurface&)>;

}  // namespace tanktread::membrane
