#include "motion/periodic.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "base/errors.hpp"
#include "base/formatted.hpp"
#include "deck/section.hpp"
#include "motion/integrator.hpp"
#include "motion/spectrum.hpp"
#include "system/rigid_motion.hpp"
#include "system/solvers/eigenvalues.hpp"
#include "system/solvers/nonlinear.hpp"

namespace tanktread::motion {

void PeriodicOptions::declare(deck::Section& section) {
  std::optional<double> expected;
  section.key("period", expected, deck::positive(), "time",
              "expected period of the motion (required); the period found is between 0.5 and 1.5 times this value. With Flow/history give "
              "a period of the flow, because the history from time 0 to this time is repeated");
  period = expected.value_or(std::numeric_limits<double>::quiet_NaN());
  section.key("turn", turn, deck::between(-360, 360), "degrees",
              "angle, in degrees, about the x2 axis by which the shape at the end of Periodic/period is rotated relative to the initial "
              "shape; positive from x3 towards x1. The shape is rotated back by this angle before it is compared with the initial shape. "
              "With 180, Periodic/period is the time of half a revolution in shear flow, which halves the cost. The rotation must not change "
              "the flow, the walls, the lattice, and the forces and torques on the particle");
  section.key("tolerance", tolerance, deck::between(1e-10, 1e-2), "1",
              "largest allowed difference between the shape and its return after a period: root mean square displacement of the control "
              "points divided by R_C, the radius of the sphere with the particle's volume; about ten times Time/tolerance is suitable. If "
              "disturbances die out almost completely within a period, the error of the shape is much smaller, less than a hundredth of this "
              "value; if they decay slowly, it can be larger");
  section.key("iterations", iterations, deck::between(1, 1000), "1",
              "largest number of iterations of NOX (a package of Trilinos) in the search for the periodic motion, each of which integrates "
              "over one period");
  section.key("difference", difference, deck::between(1e-6, 1e-1), "R_C",
              "step of the finite differences from which the Floquet multipliers are computed, if Spectrum is given: largest "
              "displacement of a control point in a perturbed initial shape, divided by R_C, the radius of the sphere with the "
              "particle's volume. Modes whose multiplier is below Time/tolerance divided by this value are not reported, because errors of "
              "time steps hide them");
}

namespace {

/// Returns the translation along `drifts` that is contained in the displacement d.
Vec3 drift(const std::vector<coupling::RigidMotion>& drifts, const State& d) {
  Vec3 all = Vec3::Zero();
  for (const coupling::RigidMotion& one : drifts) {
    const State field = moved(d, one);
    all += dot(field, d) / field.numbers().squaredNorm() * one.velocity;
  }
  return all;
}

/// Returns the displacement d without its translation along `drifts`.
State without(const std::vector<coupling::RigidMotion>& drifts, const State& d) { return d - moved(d, {.velocity = drift(drifts, d)}); }

/// Returns the shape x after a period, rotated back and moved back along free translations to the shape `start` before the period.
State returned(const PeriodicOptions& options, const State& x, const State& start) {
  const State back = turned(x, Eigen::AngleAxisd(-options.turn * std::numbers::pi / 180, Vec3::UnitY()).toRotationMatrix());
  return start + without(options.drifts, back - start);
}

/// Integrates from x until `done` returns true after a step, or the time `most` has passed.
TimeState run(coupling::Dynamics& dynamics, const TimeOptions& time, const std::shared_ptr<Teuchos::ParameterList>& nox, const State& x, double most,
          const std::function<bool(const TimeState& before, const TimeState& after)>& done) {
  TimeState state;
  state.x = x;
  dynamics.restore_constraints(state.x);
  begin(dynamics, state);
  if (!state.x.allFinite() || !state.history.front().allFinite())
    throw RunFailure("the evaluation of the velocity failed in the search for a periodic motion");
  TimeOptions until_most = time;
  until_most.final_time = most;
  state.step = time.initial_step ? *time.initial_step : first_step(dynamics, state, until_most);
  const std::unique_ptr<Integrator> scheme = integrator(until_most, nox);
  while (state.time < most * (1 - 1e-12)) {
    const TimeState before = state;
    scheme->advance(dynamics, state, most);
    if (done(before, state)) break;
  }
  return state;
}

}  // namespace

ReturnMap::ReturnMap(coupling::Dynamics& dynamics, const TimeOptions& time, std::shared_ptr<Teuchos::ParameterList> nox,
                     const PeriodicOptions& options, State c)
    : dynamics_(dynamics), time_(time), nox_(std::move(nox)), options_(options), origin_(std::move(c)) {
  if (options_.driven) return;
  normal_ = without(options.drifts, dynamics.velocity(origin_));
  if (!normal_.allFinite() || normal_.norm() == 0)
    throw RunFailure("the shape is at rest, or its velocity is not finite, so that no periodic motion can be found");
  normal_ = normal_ / normal_.norm();
}

State ReturnMap::back(const State& x) const { return returned(options_, x, origin_); }

State ReturnMap::arrived(double period, const State& start, const State& end) {
  period_ = period;
  mean_velocity_ = drift(options_.drifts, end - start) / period;
  if (options_.turn != 0) mean_velocity_[0] = mean_velocity_[2] = 0;
  return back(end);
}

State ReturnMap::operator()(const State& x) {
  if (options_.driven) {
    const TimeState after = run(dynamics_, time_, nox_, x, options_.period, [](const TimeState&, const TimeState&) { return false; });
    dynamics_.set_time(0, 0);
    return arrived(options_.period, x, after.x);
  }
  const auto ahead = [&](const State& y) { return dot(normal_, back(y) - origin_); };
  State found;
  const double most = 1.5 * options_.period;
  run(dynamics_, time_, nox_, x, most, [&](const TimeState& before, const TimeState& after) {
    const double least = 0.5 * options_.period;
    if (after.time < least || !(ahead(before.x) < 0 && ahead(after.x) >= 0)) return false;
    const DenseOutput within(before, after);
    double early = before.time, late = after.time;
    while (late - early > 1e-14 * late) {
      const double middle = 0.5 * (early + late);
      if (middle <= early || middle >= late) break;
      (ahead(within.state(middle)) < 0 ? early : late) = middle;
    }
    if (late < least) return false;
    found = arrived(late, x, within.state(late));
    return true;
  });
  if (found.empty())
    throw RunFailure(formatted("the shape did not recur within the time %.6g: give another Periodic/period or Periodic/turn", most));
  return found;
}

State after_periods(coupling::Dynamics& dynamics, const TimeOptions& time, const std::shared_ptr<Teuchos::ParameterList>& nox,
                  const PeriodicOptions& options, State x) {
  constexpr int settling = 3;
  for (int k = 0; k < settling; ++k)
    x = returned(options, run(dynamics, time, nox, x, options.period, [](const TimeState&, const TimeState&) { return false; }).x, x);
  return x;
}

PeriodicReport find_periodic(ReturnMap& map, const std::shared_ptr<Teuchos::ParameterList>& nox,
                             const std::function<State(const State& x, const State& p)>& without_sliding, State& x) {
  const auto norm = [&](const State& d) { return map.dynamics().norm(d); };
  double rest = std::numeric_limits<double>::infinity();
  const auto back = [&](const State& y) {
    State p = without_sliding(y, map(y));
    rest = norm(p - y);
    return p;
  };
  const coupling::FixedPoint solver("anderson", nox);
  const coupling::NonlinearReport found = solver.solve(back, norm, map.options().tolerance, map.options().iterations, x);
  map.dynamics().restore_constraints(x);
  return {found.iterations, found.converged, rest};
}

State ReturnMap::derivative(const State& x, const State& d) {
  const double radius = 1 / dynamics_.norm(moved(x, coupling::unit_motion(1)));  // R_C
  return central_difference(*this, x, d, options_.difference * radius);
}

std::vector<coupling::Eigenpair> multipliers(const std::function<Eigen::VectorXd(const Eigen::VectorXd&)>& derivative, Eigen::Index n, int number) {
  constexpr double exhausted = 1e-8;
  const Eigen::Index most = std::min<Eigen::Index>(2 * number + 4, n);
  Eigen::MatrixXd basis(n, most + 1), h = Eigen::MatrixXd::Zero(most + 1, most);
  for (Eigen::Index k = 0; k < n; ++k) basis(k, 0) = std::sin(1.0 + static_cast<double>(k * k % 7919));  // irregular but reproducible
  basis.col(0).normalize();
  Eigen::Index m = 0;
  do {
    Eigen::VectorXd w = derivative(basis.col(m));
    for (int pass = 0; pass < 2; ++pass) {
      const Eigen::VectorXd parts = basis.leftCols(m + 1).transpose() * w;
      h.col(m).head(m + 1) += parts;
      w -= basis.leftCols(m + 1) * parts;
    }
    h(m + 1, m) = w.norm();
    basis.col(m + 1) = w / h(m + 1, m);
  } while (h(m + 1, m) >= exhausted && ++m < most);
  m = std::min(m + 1, most);
  std::vector<coupling::Eigenpair> pairs = coupling::eigenpairs(h.topLeftCorner(m, m));
  std::ranges::stable_sort(pairs, {}, [](const coupling::Eigenpair& pair) { return -std::abs(pair.value); });
  pairs.resize(std::min<std::size_t>(pairs.size(), static_cast<std::size_t>(number)));
  for (coupling::Eigenpair& pair : pairs) pair.vector = (basis.leftCols(m) * pair.vector).eval();
  return pairs;
}

}  // namespace tanktread::motion
