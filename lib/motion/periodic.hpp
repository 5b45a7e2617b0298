#pragma once
// Periodic motions: shapes that come back after a period.

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

/// `Periodic/*` of the deck.
struct PeriodicOptions {
  bool present = false;       ///< whether the deck has this list
  double period = 0;          ///< expected
  double turn = 0;            ///< by which the shape is turned about x2 when it is back, degrees
  double tolerance = 1e-5;    ///< of what it misses of being back, in the norm of `Time/tolerance`
  int iterations = 20;        ///< most
  double difference = 1e-2;   ///< size of the displacements whose returns the multipliers are made of, over R_C
  bool driven = false;        ///< whether the flow itself changes with this period, so that returns are at its end

  void declare(deck::Section& section);
};

/// Where a motion comes back to a plane of shapes, one period T after x: with its motion phi and the turn R,
///
///   P(x) = R^-1 phi_T(x),   n.(P(x) - c) = 0,   n along v(c)                                                        (4.27)
///
/// T being between half and one and a half of the expected period. Within the last step the plane is met by DenseOutput. In a flow that changes in
/// time T is the flow's period, and there is no plane.
class ReturnMap {
 public:
  /// Through c. Motion and options outlive it. Collective, as is all else.
  ReturnMap(coupling::Dynamics& dynamics, const TimeOptions& time, std::shared_ptr<Teuchos::ParameterList> nox, const PeriodicOptions& options,
            Net c);

  /// P(x). Throws RunFailure where x does not come back.
  Net operator()(const Net& x);
  double period() const { return period_; }  ///< T of the latest

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

/// What a search came to.
struct PeriodicReport {
  int iterations = 0;
  bool converged = false;
  double rest = 0;  ///< what the shape misses of being back
};

/// x where a motion is after three expected periods, each time turned back: a plane of returns may go through there. Collective.
Net after_periods(coupling::Dynamics& dynamics, const TimeOptions& time, const std::shared_ptr<Teuchos::ParameterList>& nox,
                  const PeriodicOptions& options, Net x);

/// The fixed point of P that x leads to, by NOX (`anderson`). Collective. Throws RunFailure where a shape does not come back.
PeriodicReport find_periodic(ReturnMap& map, const std::shared_ptr<Teuchos::ParameterList>& nox, Net& x);

/// A displacement of the fixed point that P multiplies.
struct Multiplier {
  std::complex<double> value;
  Net real, imaginary;
};

/// Those of largest size of the derivative of P at its fixed point x, by central differences and Arnoldi's method from the displacement `start` on:
/// the Floquet multipliers but that of the time itself, 1. `admitted`: a displacement without what the symmetry of `start` does not admit. What is
/// smaller than noise of a run over `difference` is noise. Collective.
std::vector<Multiplier> multipliers(ReturnMap& map, const Net& x, const Net& start, const std::function<Net(const Net&)>& admitted, int number);

}  // namespace tanktread::motion
