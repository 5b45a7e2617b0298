#include "motion/options.hpp"

#include <limits>

#include "base/errors.hpp"
#include "deck/section.hpp"
#include "deck/words.hpp"

namespace tanktread::motion {

void TimeOptions::declare(deck::Section& section) {
  section.key("scheme", scheme, deck::Choice{"auto", "tr-bdf2", "bdf3", "bs3", "rkc2", "crank-nicolson"},
              "`auto`: `bs3`, `tr-bdf2` or `rkc2` by the measured stiffness, `tr-bdf2` if a velocity takes a linear system (viscosity ratio other "
              "than 1); "
              "`tr-bdf2`: implicit, L-stable, order 3 by extrapolation; `bdf3`: implicit, multistep, order 3; `bs3`: explicit, order 3; "
              "`rkc2`: explicit, stabilised, order 2, nothing assembled; `crank-nicolson`: the paper's (4.1)");
  std::optional<double> end;
  section.key("final time", end, deck::positive(), "time", "the run ends here; required, but for a `prescribed` motion");
  final_time = end.value_or(std::numeric_limits<double>::quiet_NaN());
  section.key("tolerance", tolerance, deck::between(1e-13, 1.0), "1",
              "error allowed in a step: root mean square displacement of the control points over R_C");
  section.key("initial step", initial_step, deck::positive(), "time", "the first step; if not given, the scheme finds one");
  section.key("fixed step", fixed_step, deck::positive(), "time", "every step, without control of the error");
  section.key("maximum step", maximum_step, deck::positive(), "time", "no step is longer");
  section.key("minimum step", minimum_step, deck::positive(), "time",
              "a controlled step that would be shorter ends the run; if not given, 1e-9 over the rate of the flow");
  section.key("steady tolerance", steady_tolerance, deck::positive(), "1",
              "the run ends when the series `shape_velocity` (6.8) falls below it; if not given, only at the final time. Where the "
              "membrane treads, 2e-4 is reached at the default tolerance, with 216 elements as with 864");
  section.key("end when past", end_when_past, deck::any(), "length",
              "the run ends when the centroids of all particles are past this x1, in a bent channel this way along its centre line; if not given, "
              "only at the final time");
  section.key("iteration tolerance", iteration_tolerance, deck::positive(), "1", "end of the sub-iteration of `crank-nicolson` (4.1)");
  section.key("nonlinear solver", nonlinear_solver, deck::Choice{"plain", "anderson", "newton-krylov"},
              "`crank-nicolson`: sub-iteration as it is, accelerated by NOX, or Newton's method by NOX with nothing assembled");
  section.key("step control", step_control, deck::Choice{"iterations", "error"},
              "`crank-nicolson`: steps by the number of sub-iterations, the paper's rule (4.1) and the default for `plain`, or by the error (4.10)");
  section.key("count euler step", count_euler_step,
              "`crank-nicolson`: the Euler step, which is free, counts as the first sub-iteration of the rule for the step");
  section.key("newton tolerance", newton_tolerance, deck::between(1e-12, 1.0), "1",
              "implicit schemes: largest error of a stage that its quasi-Newton iteration leaves, as a fraction of the tolerance");
  section.key("newton iterations", newton_iterations, deck::at_least(1), "1",
              "most quasi-Newton iterations of a stage before the step is halved");
  section.key("linear tolerance", linear_tolerance, deck::between(1e-14, 0.5), "1",
              "relative residual of the linear solves of the implicit step");
  section.key("contraction limit", contraction_limit, deck::between(0.01, 1.0), "1",
              "contraction rate of the iteration above which the frozen layer operator is assembled anew");
  section.key("largest operator", largest_operator, deck::positive(), "GB",
              "`auto`: no frozen operator larger than this, on all ranks together, is assembled; `rkc2` is taken instead");
  section.key("secants", secants, deck::between(0, 20), "1",
              "implicit schemes: quasi-Newton corrections remembered, from which is learnt what the Jacobian leaves out (4.13)");
  section.key("predictor order", predictor_order, deck::between(0, 3), "1",
              "`tr-bdf2`: largest order of the extrapolation of slopes that a stage starts from. Each step takes the order that would have "
              "predicted the step before best");
}

void TimeOptions::check() const {
  refuse(fixed_step && initial_step, "Time/fixed step", "Time/initial step", "give one of them");
  refuse(fixed_step && maximum_step, "Time/fixed step", "Time/maximum step", "give one of them");
  const auto not_below_the_least = [this](const char* name, const std::optional<double>& step) {
    if (step && *step < least_step())
      throw UserError(std::string("Time/") + name + " must not be shorter than Time/minimum step, " + deck::number_text(least_step()) +
                      ", but is " + deck::number_text(*step) + ".");
  };
  not_below_the_least("maximum step", maximum_step);
  not_below_the_least("initial step", initial_step);
}

}  // namespace tanktread::motion
