#pragma once
// Periodic motions: shapes that return after a period.

#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "base/types.hpp"
#include "motion/options.hpp"
#include "system/dynamics.hpp"
#include "system/solvers/eigenvalues.hpp"

namespace Teuchos {
class ParameterList;
}

namespace tanktread::deck {
class Section;
}

namespace tanktread::motion {

using coupling::State;

/// Options of the search for periodic motions, `Periodic/*` of the deck.
struct PeriodicOptions {
  bool present = false;       ///< true if the deck has the section Periodic
  double period = 0;          ///< expected period
  double turn = 0;            ///< rotation of the shape about x2 after a period, degrees; must not change flow, walls and loads
  double tolerance = 1e-5;    ///< tolerance of the distance between start and return, in the norm of `Time/tolerance`
  int iterations = 20;        ///< largest number of iterations
  double difference = 1e-2;   ///< size of the displacements in the finite differences for the multipliers, divided by the particle radius R_C
  bool driven = false;        ///< true if the flow has the period `period`; a return then occurs after one period
  std::vector<coupling::RigidMotion> drifts;  ///< orthonormal translations that leave the problem invariant

  void declare(deck::Section& section);
};

/// Return map P of a motion: the next crossing of a plane in the space of shapes, one period T later. phi: flow map of the motion; R: rotation; Q:
/// projection onto the translations that leave the problem invariant, such as translations along a periodic tube.
///
///   P(x) = (1 - Q) R^-1 phi_T(x) + Q c,   n.(P(x) - c) = 0,   n along (1 - Q) v(c)                                  (4.27)
///
/// c is a shape, and the normal n of the plane is parallel to its velocity v(c), without the free translations. T lies between 0.5 and 1.5 expected
/// periods. DenseOutput locates the crossing of the plane within the last step. If the flow itself is periodic, T is its period, and there is no
/// plane.
class ReturnMap {
 public:
  /// Defines the plane (4.27) through the shape c. The motion has returned when it crosses this plane. The motion and `time` must
  /// outlive this object. Collective, like all other functions.
  ReturnMap(coupling::Dynamics& dynamics, const TimeOptions& time, std::shared_ptr<Teuchos::ParameterList> nox, const PeriodicOptions& options,
            State c);

  /// Returns the return map of another motion with the same options. Its plane passes through the shape c.
  ReturnMap with(coupling::Dynamics& dynamics, State c) const { return {dynamics, time_, nox_, options_, std::move(c)}; }

  /// Returns P(x) (4.27), the shape at the next crossing of the plane. Throws RunFailure if the motion does not return to the plane.
  State operator()(const State& x);
  double period() const { return period_; }  ///< T of the latest return
  /// Mean velocity over the period of the latest return, along free translations. With a rotation R, only its component along x2 is known and not 0.
  const Vec3& mean_velocity() const { return mean_velocity_; }

  /// Returns the derivative of P at its fixed point x along the displacement d, by central_difference() with displacements of up to difference x R_C.
  /// Errors of the time steps change the result by about resolution() |d|.
  State derivative(const State& x, const State& d);
  double resolution() const { return time_.tolerance / options_.difference; }  ///< smallest multiplier that errors of time steps do not hide

  coupling::Dynamics& dynamics() { return dynamics_; }
  const PeriodicOptions& options() const { return options_; }

 private:
  State back(const State& x) const;
  State arrived(double period, const State& start, const State& end);

  coupling::Dynamics& dynamics_;
  const TimeOptions& time_;
  std::shared_ptr<Teuchos::ParameterList> nox_;
  PeriodicOptions options_;
  State origin_, normal_;
  double period_ = 0;
  Vec3 mean_velocity_ = Vec3::Zero();
};

/// Result of a search for a periodic motion.
struct PeriodicReport {
  int iterations = 0;
  bool converged = false;
  double rest = 0;  ///< distance between the shape and its image under the return map
};

/// Returns the shape to which the motion leads from x in three times PeriodicOptions::period. After each period, the shape is rotated back by the
/// angle `turn` of the options and moved back along free translations. The result serves as the point c of the plane in ReturnMap (Poincare section).
/// Collective.
State after_periods(coupling::Dynamics& dynamics, const TimeOptions& time, const std::shared_ptr<Teuchos::ParameterList>& nox,
                  const PeriodicOptions& options, State x);

/// Finds the shape x that the return map P (4.27) maps to itself, starting from x, by NOX (`anderson`). `without_sliding`: function of x and P(x)
/// that returns P(x) without the motion of points along interfaces since x. Collective. Throws RunFailure if a shape does not return.
PeriodicReport find_periodic(ReturnMap& map, const std::shared_ptr<Teuchos::ParameterList>& nox,
                             const std::function<State(const State& x, const State& p)>& without_sliding, State& x);

/// Returns the `number` eigenpairs of largest magnitude of a linear map on n unknowns, by Arnoldi's method with 2 `number` + 4 products. The
/// eigenvalues of the derivative of a return map are the Floquet multipliers, except the multiplier 1 of a shift in time. Collective.
std::vector<coupling::Eigenpair> multipliers(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& derivative, Eigen::Index n, int number);

}  // namespace tanktread::motion
