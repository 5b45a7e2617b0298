#pragma once
// Steady shapes.

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/types.hpp"
#include "system/dynamics.hpp"
#include "system/rigid_motion.hpp"
#include "system/solvers/options.hpp"

namespace tanktread::deck {
class Section;
}

namespace tanktread::motion {

using coupling::State;

/// Options of the search for steady shapes, `Steady/*` of the deck.
struct SteadyOptions {
  bool present = false;             ///< true if the deck has the section Steady
  std::string method = "anderson";  ///< anderson, newton-krylov
  double tolerance = 1e-8;          ///< tolerance of the estimated error of the shape (4.32), in the norm of `Time/tolerance`
  int iterations = 100;             ///< largest number of iterations
  std::optional<double> step;       ///< implicit step of the preconditioner, time; empty: chosen from the rates of flow and membranes

  void declare(deck::Section& section);
};

/// If (velocity times step)/R_C is at least this value, it is a lower bound of the error estimate of the shape. Otherwise the estimate depends only
/// on the correction. On a crumpled surface the Jacobian is so large that corrections are small although velocities are not.
constexpr double largest_motion = 0.1;

/// Result of a search for a steady shape.
struct SteadyReport {
  int iterations = 0;
  bool converged = false;
  double rest = 0;  ///< estimated error of the shape
  std::string why;  ///< reason for which the shape was not found, if SteadyEquations::obstacle() knows one
};

/// Equations of the steady shape x in a search that starts from the shape x0. Q is the projection onto the neutral directions, along which steady
/// shapes map to other steady shapes: the rigid motions about the origin in `free`, and the relabellings of surface points (Dynamics::relabellings).
/// x_V is x with its volume restored, and s is the implicit step of the preconditioner:
///
///   G(x) = (1 - Q) v(x) + (x_V - x)/s - Q (x - x0)/s = 0                                                           (4.17)
class SteadyEquations {
 public:
  /// Function that returns why searches that come to the shape x rarely find a steady shape, and what to do; empty if it knows no reason.
  using Obstacle = std::function<std::string(const State& x)>;

  /// `step`: implicit step s of the preconditioner in (4.17), a time. `start`: the shape x0. `dynamics` must outlive this object.
  SteadyEquations(coupling::Dynamics& dynamics, std::vector<coupling::RigidMotion> free, double step, State start, Obstacle obstacle = {});

  /// Returns G(x) (4.17) times the implicit step s; not finite if the evaluation fails. Collective.
  State residual(const State& x);
  /// Returns (1 - s J)^{-1} r, with the implicit step s (4.17) and the frozen Jacobian J (4.3) linearised at x. Collective.
  State precondition(const State& x, const State& r);
  double unit_length() const;                          ///< Euclidean norm of a displacement for which Dynamics::norm is 1
  std::vector<State> neutral(const State& x);  ///< returns an orthonormal basis of the neutral directions, the range of Q in (4.17). Collective
  coupling::Dynamics& dynamics() { return dynamics_; }
  double step() const { return step_; }
  std::string obstacle(const State& x) const { return obstacle_ ? obstacle_(x) : std::string(); }  ///< see Obstacle

  /// Returns these equations with another step s of (4.17).
  SteadyEquations with_step(double step) const { return {dynamics_, free_, step, start_, obstacle_}; }

 private:
  coupling::Dynamics& dynamics_;
  std::vector<coupling::RigidMotion> free_;
  double step_;
  State start_;
  Obstacle obstacle_;
};

/// Estimates the error of an iterate x_k of a fixed-point iteration from the corrections f_j = g(x_j) - x_j of the last m iterates:
///
///   x_k - x* = -f_k + (dX + dF) c,   c the least-squares solution of dF c = f_k,   dX, dF: columns x_k - x_j, f_k - f_j          (4.32)
///
/// The correction f_k is smaller than the error by the factor 1 - rho, with rho the contraction rate of the slowest mode; near a fold this factor is
/// about 1/100. The estimate is exact if g is affine and the matrix dg/dx - 1 has at most the rank m. Anderson acceleration uses the estimate as its
/// step.
class FixedPointError {
 public:
  /// `most`: largest number m of earlier iterates x_j that the estimate (4.32) uses.
  explicit FixedPointError(int most) : most_(most) {}

  /// Stores the iterate x_k and its correction f_k, which must be finite. Returns the estimate (4.32) of the error x_k - x*, where x* is the fixed
  /// point. The cost is a least-squares problem with m columns, without evaluations of the fixed-point map.
  State operator()(const State& x, const State& f);

  /// Returns true if the latest estimate (4.32) uses earlier iterates; without earlier iterates the estimate is -f_k.
  bool known() const { return before_.size() > 1; }

 private:
  int most_;
  std::deque<std::pair<State, State>> before_;  // pairs of an earlier iterate x_j and its correction f_j, latest last
};

/// Solves G(x) = 0 (4.17) by NOX, as the fixed-point equation x = x + s (1 - s J)^{-1} G(x) with the implicit step s and the frozen Jacobian J (4.3).
/// The method is Anderson acceleration (`anderson`) or Newton's method (`newton-krylov`). If one iteration would change x by 0.2 R_C or more,
/// implicit time steps shorter than s are made first. If the iteration does not converge, x is the best iterate. If there is an obstacle at the best
/// iterate (SteadyEquations::obstacle), Anderson's method ends after `most_in_vain` iterations that find no better one. Collective.
SteadyReport find_steady(SteadyEquations& equations, const SteadyOptions& options, const coupling::SolverOptions& solvers, State& x,
                         int most_in_vain = 20);

}  // namespace tanktread::motion
