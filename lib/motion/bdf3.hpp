#pragma once

#include "motion/integrator.hpp"
#include "motion/tr_bdf2.hpp"

namespace tanktread::motion {

/// Third-order backward differentiation with variable steps and the quasi-Newton solve on the frozen-geometry Jacobian (4.3): the derivative
/// at t_{n+1} of the cubic through x_{n+1}, x_n, x_{n-1}, x_{n-2} is v(x_{n+1}),
///
///   x_{n+1} - shift v(x_{n+1}) = -shift (a_0 x_n + a_1 x_{n-1} + a_2 x_{n-2}),   1/shift = sum 1/(t_{n+1} - t_{n-i})              (4.9)
///
/// One stage a step, started from the cubic through the last four places; the difference to it, times shift/(t_{n+1} - t_{n-3}), is the local
/// error. Steps grow by no more than 1.5 at a time (zero-stable below 1.53; Hairer, Norsett & Wanner, Solving ODEs I, III.5). The first three
/// steps, and the ones after an iteration that failed again and again, are TR-BDF2's.
class Bdf3 : public Integrator {
 public:
  explicit Bdf3(const TimeOptions& options) : options_(options), starter_(options) {}
  StepReport advance(coupling::Dynamics& dynamics, State& state, double limit) override;

 private:
  StepReport start(coupling::Dynamics& dynamics, State& state, double limit);
  TimeOptions options_;
  TrBdf2 starter_;
};

}  // namespace tanktread::motion
