#pragma once

#include "motion/integrator.hpp"

namespace tanktread::motion {

/// The paper's Crank-Nicolson by fixed-point sub-iteration (P-38), with its step rule (4.1):
///
///   x^{k+1} = x_n + dt/2 (v(x_n) + v(x^k))   until  |x^{k+1} - x^k|_2 / (R_C sqrt(m_C)) <= 1e-7;
///   more than 8 sub-iterations: dt x 0.75 and the step again; fewer than 4: dt x 1.33 for the next.
///
/// The first sub-iteration, from x^1 = x_n, is the Euler step. It costs no velocity evaluation; read to the letter it counts, and steps then
/// stay near the first one; not counted, the mean step is that of the paper's Table 3. Contracts only for dt rho < 2.
class CrankNicolson : public Integrator {
 public:
  explicit CrankNicolson(const TimeOptions& options) : options_(options) {}
  StepReport advance(coupling::Dynamics& dynamics, State& state, double limit) override;

 private:
  TimeOptions options_;
};

}  // namespace tanktread::motion
