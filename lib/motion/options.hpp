#pragma once

#include <optional>
#include <string>
#include <vector>

namespace tanktread::deck {
class Section;
}

namespace tanktread::motion {

inline const std::vector<std::string> schemes{"auto", "tr-bdf2", "bdf3", "bs3", "rkc2", "crank-nicolson"};  ///< words of Time/scheme

/// Options of the time integration, `Time/*` of the deck.
struct TimeOptions {
  std::string scheme = "tr-bdf2";          ///< see motion/integrator.cpp
  double final_time = 1.0;                 ///< time at which the run ends
  /// allowed error of a step: root mean square displacement of the control points divided by the particle radius R_C
  double tolerance = 1e-4;
  std::optional<double> initial_step;      ///< first step; empty: the scheme estimates one
  std::optional<double> fixed_step;        ///< size of all steps; if set, there is no error control, and only the last step is shortened
  std::optional<double> maximum_step;      ///< largest step; empty: no limit
  std::optional<double> minimum_step;      ///< smallest step of the step control; the run fails if a smaller step is needed; empty: 1e-9 times `unit`
  double unit = 1;                         ///< unit of time of the scene, the inverse rate of its flow; not a key of the deck
  /// the run ends if the shape velocity (6.8), divided by the rate of the flow times R_C, is below this value; empty: never
  std::optional<double> steady_tolerance;
  std::optional<double> end_when_past;     ///< the run ends if x1 of the centroids of all particles is larger than this; empty: never
  double iteration_tolerance = 1e-7;       ///< tolerance of the sub-iteration of crank-nicolson (4.1)
  std::string nonlinear_solver = "plain";   ///< nonlinear solver of crank-nicolson: plain, anderson, newton-krylov
  /// step control of crank-nicolson: iterations (4.1) or error (4.10). If not set: iterations if `nonlinear_solver` is plain, otherwise error
  std::optional<std::string> step_control;
  bool count_euler_step = true;             ///< true if the Euler step counts as a sub-iteration of crank-nicolson
  double newton_tolerance = 0.2;           ///< allowed error of the quasi-Newton iteration of a stage, divided by `tolerance`
  int newton_iterations = 6;               ///< largest number of iterations of a stage before the step is halved
  double linear_tolerance = 0.05;          ///< allowed relative residual of the linear solves of a stage
  /// contraction rate of the quasi-Newton iteration above which the frozen layer operator in the Jacobian (4.3) is assembled again
  double contraction_limit = 0.3;
  double largest_operator = 32;             ///< memory of the frozen layer operator above which `auto` uses rkc2, GB on all ranks together
  int secants = 2;                         ///< number of corrections stored by the quasi-Newton iteration (4.13)
  int predictor_order = 3;                 ///< largest degree of the polynomial through known slopes that predicts a stage of tr-bdf2

  double least_step() const { return minimum_step.value_or(1e-9 * unit); }
  bool assembles() const { return scheme == "tr-bdf2" || scheme == "bdf3"; }  ///< true if the scheme always assembles the frozen layer operator (4.3)
  /// Returns true if crank-nicolson controls its step by the error (4.10), false if by the number of iterations (4.1).
  bool by_error() const { return step_control ? *step_control == "error" : nonlinear_solver != "plain"; }

  void declare(deck::Section& section);

  /// Throws UserError, with a one-sentence message, if keys contradict each other.
  void check() const;
};

}  // namespace tanktread::motion
