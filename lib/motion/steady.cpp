#include "motion/steady.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "coupling/nonlinear.hpp"
#include "deck/section.hpp"

namespace tanktread::motion {

void SteadyOptions::declare(deck::Section& section) {
  section.key("method", method, deck::Choice{"anderson", "newton-krylov"},
              "of NOX, with Solvers/NOX: the fixed point of implicit steps accelerated, or found by Newton's method with Solvers/steady");
  section.key("tolerance", tolerance, deck::between(1e-13, 1e-2), "1",
              "correction that is left: root mean square displacement of the control points over R_C");
  section.key("iterations", iterations, deck::between(1, 100000), "1", "most iterations of NOX");
  section.key("step", step, deck::positive(), "time",
              "the implicit step that preconditions; if not given, half of one over the rate of the flow, or of the membrane where nothing flows");
}

namespace {

/// Control values of orthonormal fields that span rigid motions of x.
std::vector<Net> fields(const std::vector<coupling::RigidMotion>& motions, const Net& x) {
  std::vector<Net> all;
  for (const coupling::RigidMotion& motion : motions) {
    Net field = coupling::rigid_velocity(x, motion, Vec3::Zero());
    const double size = field.norm();
    for (const Net& other : all) field -= other.cwiseProduct(field).sum() * other;
    if (field.norm() > 1e-6 * size) all.push_back(field / field.norm());
  }
  return all;
}

/// G(x) (4.17) and its corrections.
class Search {
 public:
  Search(coupling::Dynamics& dynamics, const std::vector<coupling::RigidMotion>& free, const Net& start)
      : dynamics_(dynamics), free_(free), start_(start) {}

  /// delta = (1 - s J)^{-1} s G(y), not finite where it cannot be had.
  Net correction(const Net& y, double step) {
    constexpr double linear_tolerance = 1e-2;
    Net volume = y;
    dynamics_.restore_volume(volume);
    const Net v = dynamics_.velocity(y);
    Net r = step * v + (volume - y);
    for (const Net& field : fields(free_, y)) r -= (step * field.cwiseProduct(v).sum() + field.cwiseProduct(y - start_).sum()) * field;
    if (!r.allFinite()) return r;
    dynamics_.linearise(y);
    Net delta = dynamics_.symmetric(dynamics_.solve(step, r, linear_tolerance, {}));
    const double rest = dynamics_.norm(delta);
    if (rest < rest_) rest_ = rest, best_ = y;
    return delta;
  }

  /// Takes shorter implicit steps until one of full length moves x by little.
  void approach(double full, Net& x) {
    constexpr double little = 0.2;
    constexpr int most = 100;
    double step = full;
    for (int k = 0; k < most; ++k) {
      Net delta = correction(x, step);
      while (!(dynamics_.norm(delta) < little) && step > 1e-6 * full) delta = correction(x, step *= 0.5);
      if (step == full || !delta.allFinite()) return;
      x += delta;
      dynamics_.restore_volume(x);
      step = std::min(full, 4 * step);
    }
  }

  double rest() const { return rest_; }
  const Net& best() const { return best_; }
  void forget() { rest_ = std::numeric_limits<double>::infinity(); }

 private:
  coupling::Dynamics& dynamics_;
  const std::vector<coupling::RigidMotion>& free_;
  Net start_, best_ = start_;
  double rest_ = std::numeric_limits<double>::infinity();
};

}  // namespace

SteadyReport find_steady(coupling::Dynamics& dynamics, const std::vector<coupling::RigidMotion>& free, const SteadyOptions& options,
                         const coupling::SolverOptions& solvers, Net& x) {
  const double step = options.step.value();
  Search search(dynamics, free, x);
  dynamics.freeze(x);
  search.approach(step, x);
  search.forget();
  dynamics.freeze(x);
  const coupling::FixedPoint solver(options.method, solvers.nox, solvers.of(solvers.steady));
  const auto norm = [&](const Net& y) { return dynamics.norm(y); };
  const auto corrected = [&](const Net& y) -> Net { return y + search.correction(y, step); };
  const coupling::NonlinearReport found = solver.solve(corrected, norm, options.tolerance, options.iterations, x);
  x = search.best();
  dynamics.restore_volume(x);
  return {found.iterations, found.converged, search.rest()};
}

}  // namespace tanktread::motion
