#pragma once

#include <optional>
#include <string>

namespace tanktread::deck {
class Section;
}

namespace tanktread::motion {

/// The integration in time: `Time/*` of the deck.
struct TimeOptions {
  std::string scheme = "tr-bdf2";          ///< see motion/integrator.cpp
  double final_time = 1.0;                 ///< the run ends here
  double tolerance = 1e-4;                 ///< error of a step: root mean square displacement of the control points over R_C
  std::optional<double> initial_step;      ///< empty: the scheme finds one
  std::optional<double> fixed_step;        ///< steps of this size without error control, the last one shortened
  std::optional<double> maximum_step;      ///< empty: no limit
  std::optional<double> minimum_step;      ///< a controlled step below this ends the run with a failure; empty: 1e-9 of `unit`
  double unit = 1;                         ///< of time, that goes with the scene: one over the rate of its flow; no key of the deck
  std::optional<double> steady_tolerance;  ///< stop when the shape's velocity (6.8) over (rate R_C) falls below it; empty: never
  std::optional<double> end_when_past;     ///< x1 of a centroid: stop when those of all particles are larger; empty: never
  double iteration_tolerance = 1e-7;       ///< end of the sub-iteration of crank-nicolson (4.1)
  std::string nonlinear_solver = "plain";   ///< of crank-nicolson: plain, anderson, newton-krylov
  std::optional<std::string> step_control;  ///< of crank-nicolson: iterations (4.1) or error (4.10); empty: iterations where plain
  bool count_euler_step = true;             ///< whether the Euler step is the first sub-iteration of crank-nicolson
  double newton_tolerance = 0.2;           ///< error left by the quasi-Newton iteration of a stage, divided by `tolerance`
  int newton_iterations = 6;               ///< most iterations of a stage before the step is halved
  double linear_tolerance = 0.05;          ///< relative residual of its linear solves
  double contraction_limit = 0.3;          ///< contraction rate above which the frozen layer operator is assembled anew
  double largest_operator = 32;             ///< GB of the frozen operator on all ranks together beyond which `auto` does without
  int secants = 2;                         ///< corrections remembered by the quasi-Newton iteration (4.13)
  int predictor_order = 3;                 ///< largest degree of the polynomial through known slopes from which a stage of tr-bdf2 starts

  double least_step() const { return minimum_step.value_or(1e-9 * unit); }
  bool assembles() const { return scheme == "tr-bdf2" || scheme == "bdf3"; }  ///< a frozen operator of any size (4.3)
  bool by_error() const { return step_control ? *step_control == "error" : nonlinear_solver != "plain"; }  ///< of crank-nicolson

  void declare(deck::Section& section);

  /// One sentence (UserError) for keys that contradict each other.
  void check() const;
};

}  // namespace tanktread::motion
