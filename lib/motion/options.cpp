#include "motion/options.hpp"

#include <limits>

#include "base/errors.hpp"
#include "deck/section.hpp"
#include "deck/words.hpp"

namespace tanktread::motion {

namespace {

/// States which keys of the section Time have no effect with this time integration scheme.
void state_idle_keys(deck::Section& section, const std::string& scheme) {
  const std::string because = "with Time/scheme `" + scheme + "`";
  const bool automatic = scheme == "auto", explicit_scheme = scheme == "bs3" || scheme == "rkc2", paper = scheme == "crank-nicolson";
  if (!paper) section.without_effect({"iteration tolerance", "nonlinear solver", "step control", "count euler step"}, because);
  if (explicit_scheme) section.without_effect({"newton tolerance"}, because);
  if (explicit_scheme || paper)
    section.without_effect({"newton iterations", "linear tolerance", "contraction limit", "secants"}, because);
  if (!automatic) section.without_effect({"largest operator"}, because);
  if (!automatic && scheme != "tr-bdf2") section.without_effect({"predictor order"}, because);
}

}  // namespace

void TimeOptions::declare(deck::Section& section) {
  section.key("scheme", scheme, schemes,
              "time integration scheme. `auto`: `bs3`, `tr-bdf2` or `rkc2` according to the measured stiffness, but `tr-bdf2` if every velocity "
              "needs the solution of a linear system (viscosity ratio other than 1). `tr-bdf2`: implicit, L-stable, order 3 by extrapolation. "
              "`bdf3`: implicit, multistep, order 3. `bs3`: explicit Runge-Kutta, order 3. `rkc2`: explicit stabilised Runge-Kutta, order 2, "
              "stores no matrix of the boundary integrals. `crank-nicolson`: the scheme of Maestre et al. 2017 (4.1)");
  std::optional<double> end;
  section.key("final time", end, deck::positive(), "time",
              "time at which the run ends; may be left out if all motions are `prescribed`: the run then ends with its first row, the resistances");
  final_time = end.value_or(std::numeric_limits<double>::quiet_NaN());
  section.key("tolerance", tolerance, deck::between(1e-13, 1.0), "1",
              "largest allowed error of a time step: root mean square displacement of the control points divided by R_C, the radius of the "
              "sphere with the particle's volume. For more accuracy, decrease it together with Quadrature/tolerance");
  section.key("initial step", initial_step, deck::positive(), "time", "length of the first time step; chosen automatically if not given");
  section.key("fixed step", fixed_step, deck::positive(), "time", "length of all time steps; if not given, error control varies it");
  section.key("maximum step", maximum_step, deck::positive(), "time", "upper limit for the length of time steps; no limit if not given");
  section.key("minimum step", minimum_step, deck::positive(), "time",
              "smallest allowed length of time steps with error control. If a shorter step is needed, the run fails; if not given, 1e-9 "
              "divided by the rate of the flow");
  section.key("steady tolerance", steady_tolerance, deck::positive(), "1",
              "value of the series `shape_velocity` below which the shape counts as steady and the run ends: root mean square of the "
              "normal velocity that changes the shape, divided by the velocity scale of the flow (6.8). If not given, the run continues "
              "to the final time; while a table of Flow/history lasts, it continues in any case. At the default tolerances, the series falls "
              "to 2e-4 for a capsule whose membrane tank-treads; a smaller value may never be reached");
  section.key("end when past", end_when_past, deck::any(), "length",
              "position x1 (in a bent channel, arc length of the centre line); the run ends when the centroids of all particles are "
              "beyond it. If not given, the run ends at the final time");
  section.key("iteration tolerance", iteration_tolerance, deck::positive(), "1",
              "tolerance of the fixed-point iteration of Time/scheme `crank-nicolson` (4.1): root mean square change of the control points "
              "in one iteration divided by R_C, the radius of the sphere with the particle's volume");
  section.key("nonlinear solver", nonlinear_solver, deck::Choice{"plain", "anderson", "newton-krylov"},
              "solver of the nonlinear equations of a step of Time/scheme `crank-nicolson`. `plain`: fixed-point iteration, as by Maestre "
              "et al. (2017). `anderson`: fixed-point iteration with Anderson acceleration by NOX, the nonlinear solvers of Trilinos. "
              "`newton-krylov`: Newton's method by NOX without an assembled Jacobian");
  section.key("step control", step_control, deck::Choice{"iterations", "error"},
              "choice of the step length of Time/scheme `crank-nicolson`. `iterations`: from the number of fixed-point iterations, as by "
              "Maestre et al. 2017 (4.1); default for Time/nonlinear solver `plain`. `error`: from the estimated error (4.10)");
  section.key("count euler step", count_euler_step,
              "whether Time/step control `iterations` counts the initial guess, an explicit Euler step that needs no evaluation, as the "
              "first fixed-point iteration of a `crank-nicolson` step");
  section.key("newton tolerance", newton_tolerance, deck::between(1e-12, 1.0), "1",
              "largest allowed error of the quasi-Newton iteration in a stage of an implicit time step, divided by Time/tolerance");
  section.key("newton iterations", newton_iterations, deck::at_least(1), "1",
              "largest number of quasi-Newton iterations in a stage of an implicit time step; if more are needed, the step is halved");
  section.key("linear tolerance", linear_tolerance, deck::between(1e-14, 0.5), "1",
              "relative residual of the linear systems in implicit time steps; smaller by 10/lambda for viscosity ratios lambda from 10 to 2e4");
  section.key("contraction limit", contraction_limit, deck::between(0.01, 1.0), "1",
              "convergence factor of the quasi-Newton iteration in implicit time steps (size of a correction divided by the previous one) "
              "above which the boundary-integral operator in the Jacobian, which is kept over several steps, is assembled again");
  section.key("largest operator", largest_operator, deck::positive(), "GB",
              "memory of the stored boundary-integral operator, on all MPI ranks together, above which Time/scheme `auto` uses the "
              "explicit scheme `rkc2` instead of an implicit one");
  section.key("secants", secants, deck::between(0, 20), "1",
              "number of earlier quasi-Newton corrections from which implicit time steps estimate the terms that the approximate Jacobian "
              "neglects (4.13); 0: no estimate");
  section.key("predictor order", predictor_order, deck::between(0, 3), "1",
              "largest degree of the polynomial through earlier velocities that predicts the initial guess of a stage of Time/scheme "
              "`tr-bdf2`. Each step uses the degree that would have been best for the previous step");
  state_idle_keys(section, scheme);
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
