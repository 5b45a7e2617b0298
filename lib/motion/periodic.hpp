#pragma once
// Periodic motions: shapes that return after a period.

#include <complex>
#include <functional>
#include <memory>
#include <vector>

#include "base/types.hpp"
#include "motion/options.hpp"
#include "system/dynamics.hpp"

namespace Teuchos {
class ParameterList;
}

namespace tanktread::deck {
class Section;
}

namespace tanktread::motion {

/// Options of the search for periodic motions, `Periodic/*` of the deck.
struct PeriodicOptions {
  bool present = false;       ///< true if the deck has the section Periodic
  double period = 0;          ///< expected period
  double turn = 0;            ///< rotation of the shape about x2 after a period, degrees
  double tolerance = 1e-5;    ///< tolerance of the distance between start and return, in the norm of `Time/tolerance`
  int iterations = 20;        ///< largest number of iterations
  double difference = 1e-2;   ///< size of the displacements in the finite differences for the multipliers, divided by the particle radius R_C
  bool driven = false;        ///< true if the flow has the period `period`; a return then occurs after one period

  void declare(deck::Section& section);
};

/// Return map P of a motion: the next crossing of a plane in the space of shapes, one period T later. phi: flow map of the motion; R: rotation.
///
///   P(x) = R^-1 phi_T(x),   n.(P(x) - c) = 0,   n along v(c)                                                        (4.27)
///
/// c is a shape, and the normal n of the plane is parallel to its velocity v(c). T lies between 0.5 and 1.5 expected periods. DenseOutput locates the
/// crossing of the plane within the last step. If the flow itself is periodic, T is its period, and there is no plane.
class ReturnMap {
 public:
  /// Defines the plane (4.27) through the shape c. The motion has returned when it crosses this plane. Motion and options must outlive this object.
  /// Collective, like all other functions.
  ReturnMap(coupling::Dynamics& dynamics, const TimeOptions& time, std::shared_ptr<Teuchos::ParameterList> nox, const PeriodicOptions& options,
            Net c);

  /// Returns P(x) (4.27), the shape at the next crossing of the plane. Throws RunFailure if the motion does not return to the plane.
  Net operator()(const Net& x);
  double period() const { return period_; }  ///< T of the latest return

  coupling::Dynamics& dynamics() { return dynamics_; }
  const PeriodicOptions& options() const { return options_; }

 private:
  double beyond(const Net& x) const { return normal_.cwiseProduct(x - origin_).sum(); }

  coupling::Dynamics& dynamics_;
  const TimeOptions& time_;
  std::shared_ptr<Teuchos::ParameterList> nox_;
  const PeriodicOptions& options_;
  Net origin_, normal_;
  double period_ = 0;
};

/// Result of a search for a periodic motion.
struct PeriodicReport {
  int iterations = 0;
  bool converged = false;
  double rest = 0;  ///< distance between the shape and its image under the return map
};

/// Returns the shape to which the motion leads from x in three times PeriodicOptions::period. After each period, the shape is rotated back by the
/// angle `turn` of the options. The result serves as the point c of the plane in ReturnMap (Poincare section). Collective.
Net after_periods(coupling::Dynamics& dynamics, const TimeOptions& time, const std::shared_ptr<Teuchos::ParameterList>& nox,
                  const PeriodicOptions& options, Net x);

/// Finds the fixed point of the return map P (4.27), starting from x, by NOX (`anderson`). Collective. Throws RunFailure if a shape does not return.
PeriodicReport find_periodic(ReturnMap& map, const std::shared_ptr<Teuchos::ParameterList>& nox, Net& x);

/// Floquet multiplier: an eigenvalue of the derivative of the return map P (4.27), with the real and imaginary part of its eigenvector.
struct Multiplier {
  std::complex<double> value;
  Net real, imaginary;
};

/// Returns the `number` largest eigenvalues of the derivative of the return map P (`map`) at its fixed point x, by central differences and Arnoldi's
/// method started from the displacement `start`. These are the Floquet multipliers except the trivial one, 1. `admitted`: removes from a displacement
/// the parts that break the symmetry of `start`. Eigenvalues smaller than the numerical noise of a run divided by the option `difference` are not
/// significant. Collective.
std::vector<Multiplier> multipliers(ReturnMap& map, const Net& x, const Net& start, const std::function<Net(const Net&)>& admitted, int number);

}  // namespace tanktread::motion
