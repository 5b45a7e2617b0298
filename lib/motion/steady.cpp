#include "motion/steady.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include <Eigen/QR>

#include "deck/section.hpp"
#include "system/solvers/nonlinear.hpp"

namespace tanktread::motion {

void SteadyOptions::declare(deck::Section& section) {
  section.key("method", method, deck::Choice{"anderson", "newton-krylov"},
              "method by which the steady shape is found, from NOX (a package of Trilinos with parameters in Solvers/NOX). `anderson`: "
              "Anderson acceleration of a fixed-point iteration, each iteration an implicit time step. `newton-krylov`: Newton's method "
              "with the linear solver Solvers/steady");
  section.key("tolerance", tolerance, deck::between(1e-13, 1e-2), "1",
              "largest allowed estimated error of the steady shape (4.32), or with Continuation the size of the last correction: root "
              "mean square displacement of the control points divided by R_C, the radius of the sphere with the particle's volume");
  section.key("iterations", iterations, deck::between(1, 100000), "1",
              "largest number of iterations of NOX (a package of Trilinos) in the search for the steady shape");
  section.key("step", step, deck::positive(), "time",
              "length of the implicit time step that preconditions the equations of the steady shape; decrease it if the shape is not found. "
              "If not given, 0.5 divided by the rate of the flow (without flow, 0.5 relaxation times), but at most ten times the relaxation "
              "time of any membrane. The relaxation time is viscosity x R_C/modulus, where R_C is the radius of the sphere with the particle's "
              "volume");
}

namespace {

/// Adds the component of `field` that is orthogonal to the orthonormal fields in `all`, normalised, if its norm is more than the fraction `least` of
/// the field's norm.
void join(std::vector<State>& all, State field, double least) {
  const double size = field.norm();
  for (const State& other : all) field -= dot(other, field) * other;
  if (field.norm() > least * size) all.push_back(field / field.norm());
}

}  // namespace

SteadyEquations::SteadyEquations(coupling::Dynamics& dynamics, std::vector<coupling::RigidMotion> free, double step, State start, Obstacle obstacle)
    : dynamics_(dynamics), free_(std::move(free)), step_(step), start_(std::move(start)), obstacle_(std::move(obstacle)) {}

std::vector<State> SteadyEquations::neutral(const State& x) {
  // Thresholds of the orthogonalisation: a field is dropped if its component orthogonal to the previous fields is smaller than this fraction of its
  // norm. `rounding`, for rigid motions, is above round-off. `between_meshes` is for motions of points along the surface (relabellings) and is above
  // the mesh error: on an axisymmetric drop, such a motion and a rigid rotation differ only by the mesh error.
  constexpr double rounding = 1e-6, between_meshes = 0.05;
  std::vector<State> all;
  for (const coupling::RigidMotion& motion : free_) join(all, moved(x, motion), rounding);
  for (const State& field : dynamics_.relabellings(x)) join(all, field, between_meshes);
  return all;
}

State SteadyEquations::residual(const State& x) {
  State volume = x;
  dynamics_.restore_constraints(volume);
  const State v = dynamics_.velocity(x);
  if (!v.allFinite()) return v;  // the neutral directions of such a shape may not exist
  State r = step_ * v + (volume - x);
  for (const State& field : neutral(x)) r -= (step_ * dot(field, v) + dot(field, x - start_)) * field;
  return r;
}

State SteadyEquations::precondition(const State& x, const State& r) {
  constexpr double linear_tolerance = 1e-2;
  if (!r.allFinite()) return r;
  dynamics_.linearise(x);
  return dynamics_.symmetric(dynamics_.solve(step_, r, linear_tolerance, {}));
}

double SteadyEquations::unit_length() const {
  const State unit = moved(start_, coupling::unit_motion(1));
  return unit.norm() / dynamics_.norm(unit);
}

State FixedPointError::operator()(const State& x, const State& f) {
  // A column of dF (4.32) is ignored if its component orthogonal to the other columns is shorter than this fraction of the column.
  constexpr double independent = 1e-6;
  Eigen::MatrixXd dx(x.numbers().size(), static_cast<Eigen::Index>(before_.size())), df(dx.rows(), dx.cols());
  for (Eigen::Index j = 0; j < dx.cols(); ++j) {
    const auto& [other_x, other_f] = before_[static_cast<std::size_t>(j)];
    const double size = std::max((f.numbers() - other_f.numbers()).norm(), std::numeric_limits<double>::min());
    dx.col(j) = (x.numbers() - other_x.numbers()) / size, df.col(j) = (f.numbers() - other_f.numbers()) / size;
  }
  State error = -1 * f;
  if (dx.cols() > 0) {
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors;
    factors.setThreshold(independent);
    const Eigen::VectorXd c = factors.compute(df).solve(f.numbers());
    error.numbers() += (dx + df) * c;
  }
  before_.emplace_back(x, f);
  if (static_cast<int>(before_.size()) > most_) before_.pop_front();
  return error;
}

namespace {

/// Makes implicit time steps, each so short that it changes x by less than `little`, until a step of the full length equations.step() also changes x
/// by less than `little`. Returns whether x has changed.
bool approach(SteadyEquations& equations, State& x) {
  constexpr double little = 0.2;
  constexpr int most = 100;
  const double full = equations.step();
  double step = full;
  for (int k = 0; k < most; ++k) {
    State delta;
    const auto moves_little = [&] {
      SteadyEquations shorter = equations.with_step(step);
      delta = shorter.precondition(x, shorter.residual(x));
      return equations.dynamics().norm(delta) < little;
    };
    while (!moves_little() && step > 1e-6 * full) step *= 0.5;
    if (step == full || !delta.allFinite()) return k > 0;
    State next = x + delta;
    equations.dynamics().restore_constraints(next);
    if (!next.allFinite()) return k > 0;
    x = std::move(next);
    step = std::min(full, 4 * step);
  }
  return true;
}

}  // namespace

SteadyReport find_steady(SteadyEquations& equations, const SteadyOptions& options, const coupling::SolverOptions& solvers, State& x,
                         int most_in_vain) {
  coupling::Dynamics& dynamics = equations.dynamics();
  dynamics.freeze(x);
  if (approach(equations, x)) dynamics.freeze(x);
  State best = x;
  double rest = std::numeric_limits<double>::infinity(), latest = rest;
  const bool bare = options.method == "newton-krylov" && solvers.steady.preconditioner == "none";
  const int depth = coupling::FixedPoint::deep(x.numbers().size());
  FixedPointError error(depth);
  int in_vain = 0;  // number of iterations since the best iterate
  const auto corrected = [&](const State& y) -> State {
    const State r = equations.residual(y), delta = equations.precondition(y, r);
    latest = dynamics.norm(delta);
    if (delta.allFinite()) latest = std::max(latest, dynamics.norm(error(y, delta)));
    if (const double moved = dynamics.norm(r); !(moved < largest_motion)) latest = std::max(latest, moved);
    ++in_vain;
    if (latest < rest) rest = latest, best = y, in_vain = 0;
    if (in_vain == most_in_vain && options.method == "anderson" && !equations.obstacle(best).empty())
      return coupling::not_a_number(y);  // ends the iteration
    return y + (bare ? r : delta);
  };
  const auto norm = [&](const State& y) { return dynamics.norm(y); };
  // Norm of the error for NOX. A single correction gives no error estimate, so the first correction ends the iteration only if it is 0.
  const coupling::FixedPoint::Norm error_norm = [&](const State&) {
    return latest == 0 || error.known() ? latest : std::numeric_limits<double>::max();
  };
  const coupling::FixedPoint solver(options.method, solvers.nox, solvers.of(solvers.steady), depth);
  const coupling::NonlinearReport found = solver.solve(corrected, norm, options.tolerance, options.iterations, x, error_norm);
  x = std::move(best);
  dynamics.restore_constraints(x);
  return {found.iterations, found.converged, rest, found.converged ? "" : equations.obstacle(x)};
}

}  // namespace tanktread::motion
